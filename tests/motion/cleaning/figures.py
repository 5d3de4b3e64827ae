"""A small figure whose motion is known exactly, on DeepMimic's skeleton: it sways, swings and walks on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon import rotations
from unicon.motion.cleaning import Cleaning, Hints, Overrides, clean
from unicon.motion.source_motion import SourceMotion

JOINTS = {
    "root": ("", (0.0, 0.0, 0.0)),
    "chest": ("root", (0.0, 0.0, 0.24)),
    "neck": ("chest", (0.0, 0.0, 0.22)),
    "right_hip": ("root", (0.0, -0.085, 0.0)),
    "right_knee": ("right_hip", (0.0, 0.0, -0.42)),
    "right_ankle": ("right_knee", (0.0, 0.0, -0.41)),
    "right_shoulder": ("chest", (-0.02, -0.18, 0.24)),
    "right_elbow": ("right_shoulder", (0.0, 0.0, -0.27)),
    "right_wrist": ("right_elbow", (0.0, 0.0, -0.26)),
    "left_hip": ("root", (0.0, 0.085, 0.0)),
    "left_knee": ("left_hip", (0.0, 0.0, -0.42)),
    "left_ankle": ("left_knee", (0.0, 0.0, -0.41)),
    "left_shoulder": ("chest", (-0.02, 0.18, 0.24)),
    "left_elbow": ("left_shoulder", (0.0, 0.0, -0.27)),
    "left_wrist": ("left_elbow", (0.0, 0.0, -0.26)),
}
NAMES = tuple(JOINTS)
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def figure(count: int, rate_hz: float = 60.0, height: float = 0.83) -> SourceMotion:
    """Stand still with hanging arms."""
    root_pos = np.tile([0.0, 0.0, height], (count, 1))
    quat = np.zeros((count, len(NAMES), 4))
    quat[..., 0] = 1.0
    parents = [NAMES.index(above) if above else -1 for above, _ in JOINTS.values()]
    offsets = np.array([offset for _, offset in JOINTS.values()])
    times_s = np.arange(count) / rate_hz
    return SourceMotion("take", "deepmimic", NAMES, np.array(parents), offsets, times_s, root_pos, quat)


def turned(motion: SourceMotion, joint: str, axis: str, angle: np.ndarray | float, frames=slice(None)):
    """Turn a joint by an angle [rad] more, in some frames."""
    quat = motion.local_quat.copy()
    index = NAMES.index(joint)
    size = len(quat[frames])
    turn = rotations.from_axis_angle(np.array(AXES[axis]), np.broadcast_to(angle, size).astype(float))
    quat[frames, index] = rotations.multiply(quat[frames, index], turn)
    return replace(motion, local_quat=quat)


def moved(motion: SourceMotion, offset: np.ndarray) -> SourceMotion:
    """Move the root by offsets ``(T, 3)`` or ``(3,)`` [m]."""
    return replace(motion, root_pos=motion.root_pos + offset)


def lively(count: int = 300, rate_hz: float = 60.0, speed: float = 0.8) -> SourceMotion:
    """Walk on with swinging arms and legs, as no program does it: every joint at its own pace."""
    t = np.arange(count) / rate_hz
    motion = moved(figure(count, rate_hz), np.outer(t * speed, [1.0, 0.0, 0.0]))
    motion = moved(motion, np.outer(0.02 * np.sin(7.0 * t), [0.0, 0.0, 1.0]))
    for n, joint in enumerate(("left_hip", "right_hip", "left_shoulder", "right_shoulder", "chest", "neck")):
        motion = turned(motion, joint, "y", 0.3 * np.sin((5.1 + 0.2 * n) * t + 3.0 * n))
    for n, joint in enumerate(("left_knee", "right_knee", "left_elbow", "right_elbow")):
        sign = 1.0 if "knee" in joint else -1.0
        motion = turned(motion, joint, "y", sign * (0.5 + 0.4 * np.sin((5.1 + 0.2 * n) * t + 2.0 * n)))
    return motion


def arms_out(count: int, rate_hz: float = 60.0) -> SourceMotion:
    """Stand with the arms out to the sides."""
    motion = turned(figure(count, rate_hz), "left_shoulder", "x", np.pi / 2)
    return turned(motion, "right_shoulder", "x", -np.pi / 2)


def joined(*motions: SourceMotion) -> SourceMotion:
    """Play motions one after the other, at the rate of the last."""
    rate_s = float(motions[-1].times_s[1])
    quat = np.concatenate([m.local_quat for m in motions])
    root_pos = np.concatenate([m.root_pos for m in motions])
    return replace(motions[0], local_quat=quat, root_pos=root_pos, times_s=np.arange(len(quat)) * rate_s)


def chosen(motion: SourceMotion, frames: np.ndarray) -> SourceMotion:
    """Play some frames, some of them several times, at the same rate."""
    times_s = np.arange(len(frames)) * motion.times_s[1]
    return replace(
        motion, local_quat=motion.local_quat[frames], root_pos=motion.root_pos[frames], times_s=times_s
    )


def cleaned(motion: SourceMotion, overrides: Overrides | None = None, **hints) -> Cleaning:
    """Clean with no overrides unless there are some."""
    return clean(motion, Hints(**{"file": "archive.zip/take.bvh", **hints}), overrides or Overrides())


def found(cleaning: Cleaning) -> list[tuple[str, str]]:
    """What was decided, for which reason."""
    return [(decision.what, decision.reason) for decision in cleaning.decisions]
