"""Writes BVH for animators' tools (Blender, Maya, MotionBuilder): y up, a T-pose at rest, 60 Hz.

Joints carry the names that those tools map by themselves. The rest pose is a T-pose, not our hanging arms:
with A the turn of a body from our zero pose to the T-pose and R its rotation in the world, its joint turns
by R A^-1, and the offset o of a body on it becomes A o, so that every joint is where it was,
R A^-1 A o = R o. Every joint has three rotations, whatever its hinges. The root turns about the vertical
first (channels Y, X, Z), which keeps a person who turns around far from the angles where Euler
angles jump; the others have the usual Z, Y, X.
"""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from unicon import rotations, state
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.retargeting.euler import wrap
from unicon.motion.store.library_index import replace_file
from unicon.state import CharacterState

Unit = Literal["cm", "m"]
UNIT_M: dict[Unit, float] = {"cm": 0.01, "m": 1.0}

JOINT_NAMES = {
    "pelvis": "Hips",
    "abdomen": "Spine",
    "chest": "Spine1",
    "head": "Head",
    "clavicle": "Shoulder",
    "upper_arm": "Arm",
    "forearm": "ForeArm",
    "hand": "Hand",
    "thigh": "UpLeg",
    "shin": "Leg",
    "foot": "Foot",
    "toe": "ToeBase",
}
"""Our bodies' names as MotionBuilder, Mixamo and CMU's conversions have them; sides stand before them."""

_ENDS = {"head": (0.0, 0.0, 0.33), "hand": (0.0, 0.0, -0.18), "toe": (0.07, 0.0, 0.0)}
"""Where the last bones end in their bodies' frames [m]."""
_ARM_TURN = 0.5 * np.pi
"""From hanging to sideways."""
_ORDERS = {True: ("YXZ", "ZYX"), False: ("ZYX", "XZY")}
"""For the root and for others: channels in the file's axes, and the same axes in ours."""


def write_bvh(frames: CharacterState, path: Path, unit: Unit = "cm") -> None:
    """Write frames ``(T,)`` at 60 Hz.

    Raises:
        UniconError: when the file cannot be written; one that was there stays as it was.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, to_bvh(frames, unit))
    except OSError as error:
        reason = error.strerror or error
        raise UniconError(f"{path}: cannot be written ({reason}); choose another place with --out") from error


def to_bvh(frames: CharacterState, unit: Unit = "cm") -> str:
    """Return frames ``(T,)`` at 60 Hz as the text of a BVH file."""
    scale = 1.0 / UNIT_M[unit]
    places = _to_y_up(frames.root_pos_w) * scale
    channels = np.concatenate([places, np.degrees(_angles(frames))], axis=1)
    rows = io.StringIO()
    np.savetxt(rows, np.round(channels, 6) + 0.0, fmt="%.6f")
    head = f"MOTION\nFrames: {len(channels)}\nFrame Time: {1.0 / RATE_HZ:.10f}\n"
    return "HIERARCHY\n" + "".join(_hierarchy(0, scale, "")) + head + rows.getvalue()


def joint_name(body: str) -> str:
    """Return a body's name in the file, e.g. LeftUpLeg for left_thigh."""
    side, _, part = body.partition("_")
    if side in ("left", "right"):
        return side.capitalize() + JOINT_NAMES[part]
    return JOINT_NAMES[body]


def at_60_hz(times_s: np.ndarray, frames: CharacterState) -> CharacterState:
    """Return frames ``(T,)`` of rising times ``(T,)`` [s] at 60 Hz: what a recording lost is filled in."""
    count = int((times_s[-1] - times_s[0]) * RATE_HZ + 1e-3) + 1
    if len(times_s) < 2:
        return frames
    times = times_s[0] + np.arange(count) / RATE_HZ
    right = np.clip(np.searchsorted(times_s, times, side="right"), 1, len(times_s) - 1)
    share = (times - times_s[right - 1]) / (times_s[right] - times_s[right - 1])
    return state.interpolate(frames[right - 1], frames[right], np.clip(share, 0.0, 1.0))


def _hierarchy(body: int, scale: float, indent: str) -> list[str]:
    """Return the lines of a body and of all that hangs on it."""
    name, parent = HUMANOID.body_names[body], int(HUMANOID.parents[body])
    root = parent < 0
    offset = np.zeros(3) if root else _rest_offset(parent, HUMANOID.offsets[body])
    places = "Xposition Yposition Zposition " if root else ""
    turns = " ".join(f"{axis}rotation" for axis in _ORDERS[root][0])
    lines = [
        f"{indent}{'ROOT' if root else 'JOINT'} {joint_name(name)}\n{indent}{{\n",
        f"{indent}  OFFSET {_vector(offset * scale)}\n",
        f"{indent}  CHANNELS {6 if root else 3} {places}{turns}\n",
    ]
    for child in np.flatnonzero(HUMANOID.parents == body):
        lines += _hierarchy(int(child), scale, indent + "  ")
    end = _ENDS.get(name.split("_")[-1])
    if end is not None:
        place = _vector(_rest_offset(body, np.array(end)) * scale)
        lines.append(f"{indent}  End Site\n{indent}  {{\n{indent}    OFFSET {place}\n{indent}  }}\n")
    return [*lines, f"{indent}}}\n"]


def _vector(v: np.ndarray) -> str:
    return " ".join(f"{value:.6f}" for value in np.round(_to_y_up(v), 6) + 0.0)


def _angles(frames: CharacterState) -> np.ndarray:
    """Return all rotation channels ``(T, 60)`` [rad]."""
    local = np.array(forward_kinematics(frames).local_quat)
    local[:, 0] = frames.root_quat_w
    channels = []
    for body, parent in enumerate(HUMANOID.parents):
        turn = rotations.multiply(local[:, body], rotations.conjugate(_REST[body]))
        if parent >= 0:
            turn = rotations.multiply(_REST[parent], turn)
        channels.append(_euler_path(turn, _ORDERS[parent < 0][1]))
    return np.concatenate(channels, axis=1)


def _euler_path(quat: np.ndarray, order: str) -> np.ndarray:
    """Return angles ``(T, 3)`` [rad] that are exactly the rotations ``(T, 4)`` and jump as little as can be.

    The angles (x, y, z) and (x + pi, pi - y, z + pi) are the same rotation; from frame to frame the nearer
    pair is taken, and whole turns go on.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        first = Rotation.from_quat(rotations.wxyz_to_xyzw(quat)).as_euler(order)
    second = first * np.array([1.0, -1.0, 1.0]) + np.pi
    stays, crosses = (np.abs(wrap(path[1:] - first[:-1])).sum(axis=1) for path in (first, second))
    on_second = np.concatenate([[False], np.cumsum(crosses < stays) % 2 == 1])[:, None]
    return np.unwrap(np.where(on_second, second, first), axis=0)


def _rest_turns() -> np.ndarray:
    """Return each body's turn ``(20, 4)`` from our zero pose to the T-pose."""
    turns = np.zeros((len(HUMANOID.body_names), 4))
    turns[:, 0] = 1.0
    for body, name in enumerate(HUMANOID.body_names):
        side, _, part = name.partition("_")
        if part in ("upper_arm", "forearm", "hand"):
            angle = np.array(_ARM_TURN if side == "left" else -_ARM_TURN)
            turns[body] = rotations.from_axis_angle(np.array([1.0, 0.0, 0.0]), angle)
    return turns


_REST = _rest_turns()


def _rest_offset(body: int, offset: np.ndarray) -> np.ndarray:
    return rotations.rotate(_REST[body], offset)


def _to_y_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x forward, y left, z up into x left, y up, z forward."""
    return vectors[..., [1, 2, 0]]
