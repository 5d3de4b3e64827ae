"""Brings a motion of any skeleton onto the humanoid, in closed form.

1. Every body takes the world rotation of its joint in the source, after the turn that brings our zero
   pose onto the source's rest pose (none where both are alike; else bone by bone).
2. Elbows and knees are hinges: the plane in which a limb bends gives the twist of upper arm and thigh.
3. The rotations between neighbours become hinge angles, continuous in time; the trunk is shared evenly
   by abdomen and chest.
4. The root's path is scaled by the ratio of the legs' lengths, and put on the floor.

Frames are resampled to 60 Hz before all this, spherically for rotations and linearly for the root.
Nothing is filtered in time but the height's correction, so the ends of a clip are as fast as its middle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from unicon import rotations
from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.humanoid.table import BODIES
from unicon.motion.clip import RATE_HZ, Clip, clip_from_poses, continuous_signs
from unicon.motion.euler import hinge_angle, hinge_angles
from unicon.motion.ground import height_correction, lowest_point
from unicon.motion.source_motion import SourceMotion

VERSION = 1
"""Raised whenever clips come out differently, so that cached ones are made again."""

MAPPINGS = Path(__file__).parent / "mappings"
STRAIGHT_RAD, BENT_RAD = 0.15, 0.5
"""From where to where the plane of a bending limb gains weight over the source's own twist."""

_LIMBS = (("upper_arm", "forearm", -1.0), ("thigh", "shin", 1.0))
"""Upper and lower part, and which way the hinge between them turns when it bends."""


@dataclass(frozen=True)
class Mapping:
    """Which joint of a skeleton family moves which of our bodies."""

    family: str
    unit_m: float
    align: str
    joints: dict[str, str]


@cache
def load_mapping(family: str) -> Mapping:
    """Return the mapping of a skeleton family.

    Raises:
        InputFileError: when there is none; the message lists those there are.
    """
    path = MAPPINGS / f"{family}.yaml"
    if not path.exists():
        known = ", ".join(sorted(p.stem for p in MAPPINGS.glob("*.yaml")))
        raise InputFileError(f"{path}: there is no mapping for skeletons {family!r}; there are {known}")
    content: dict[str, Any] = yaml.safe_load(path.read_text())
    return Mapping(family, content["unit_m"], content["align"], content["joints"])


def retarget(motion: SourceMotion) -> Clip:
    """Return the motion on our humanoid at 60 Hz.

    Raises:
        InputFileError: when a joint that the mapping names is missing, or the motion is too short.
    """
    mapping = load_mapping(motion.family)
    _check_joints(motion, mapping)
    motion = resample(motion)
    turns = _body_rotations(motion, mapping)
    for side in ("left", "right"):
        for upper, lower, sign in _LIMBS:
            _make_hinge(turns, f"{side}_{upper}", f"{side}_{lower}", sign)
    joint_pos = _joint_angles(turns)
    root_pos = motion.root_pos * _leg_ratio(motion, mapping)
    clip = clip_from_poses(
        motion.name,
        root_pos,
        turns["pelvis"],
        joint_pos,
        source=motion.source,
        licence=motion.licence,
        label=motion.label,
    )
    return _put_on_floor(clip)


def resample(motion: SourceMotion) -> SourceMotion:
    """Return the motion at 60 Hz.

    Raises:
        InputFileError: when it is shorter than two frames of 60 Hz.
    """
    count = int(np.floor(motion.times_s[-1] * RATE_HZ + 1e-6)) + 1
    if count < 2:
        raise InputFileError(f"{motion.name}: lasts {motion.times_s[-1]:.3f} s, too short for a clip")
    times_s = np.arange(count) / RATE_HZ
    right = np.clip(np.searchsorted(motion.times_s, times_s, side="right"), 1, len(motion.times_s) - 1)
    left = right - 1
    share = (times_s - motion.times_s[left]) / (motion.times_s[right] - motion.times_s[left])
    share = np.clip(share, 0.0, 1.0)
    joints = np.repeat(share[:, None], len(motion.parents), axis=1)
    turns = rotations.slerp(motion.local_quat[left], motion.local_quat[right], joints)
    root_pos = motion.root_pos[left] + share[:, None] * (motion.root_pos[right] - motion.root_pos[left])
    values = {**vars(motion), "times_s": times_s, "local_quat": turns, "root_pos": root_pos}
    return SourceMotion(**values)


def _check_joints(motion: SourceMotion, mapping: Mapping) -> None:
    missing = [joint for joint in mapping.joints.values() if joint not in motion.joint_names]
    if missing:
        raise InputFileError(
            f"{motion.name}: has no joint {missing[0]!r}, which the mapping {mapping.family!r} needs; "
            f"its joints are {', '.join(motion.joint_names[:40])}"
        )


def _body_rotations(motion: SourceMotion, mapping: Mapping) -> dict[str, np.ndarray]:
    """Return the world rotation ``(T, 4)`` of every mapped body."""
    world = motion.global_rotations()
    rest = motion.rest_positions()
    turns = {}
    for body, joint in mapping.joints.items():
        index = motion.joint_names.index(joint)
        align = np.array([1.0, 0.0, 0.0, 0.0])
        if mapping.align == "bones":
            align = _bone_alignment(body, motion, mapping, rest)
        turns[body] = continuous_signs(rotations.multiply(world[:, index], align))
    return turns


_NEXT_BODY = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}
_SAME_AS = {"hand": "forearm"}
"""A hand has no bone after it: at rest it lies along the forearm."""


def _bone_alignment(body: str, motion: SourceMotion, mapping: Mapping, rest: np.ndarray) -> np.ndarray:
    """Return the shortest turn from our zero pose's limb to the source's at rest."""
    side, _, part = body.partition("_")
    part = _SAME_AS.get(part, part)
    if part not in _NEXT_BODY:
        return np.array([1.0, 0.0, 0.0, 0.0])
    start = motion.joint_names.index(mapping.joints[f"{side}_{part}"])
    end = motion.joint_names.index(mapping.joints[f"{side}_{_NEXT_BODY[part]}"])
    return _shortest_turn(np.array([0.0, 0.0, -1.0]), rest[end] - rest[start])


def _shortest_turn(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the turn ``(4,)`` that brings the direction of a to that of b."""
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    if a @ b < -1 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    return rotations.normalize(np.array([1 + a @ b, *np.cross(a, b)]))


def _make_hinge(turns: dict[str, np.ndarray], upper: str, lower: str, sign: float) -> None:
    """Twist the upper part so that the lower one only turns about its y axis against it."""
    down = np.array([0.0, 0.0, -1.0])
    along, onward = rotations.rotate(turns[upper], down), rotations.rotate(turns[lower], down)
    normal = sign * np.cross(along, onward)
    sine = np.linalg.norm(normal, axis=-1)
    bend = np.arctan2(sine, np.sum(along * onward, axis=-1))
    normal_b = rotations.rotate_inverse(turns[upper], normal / np.maximum(sine, 1e-9)[:, None])
    twist = np.arctan2(-normal_b[:, 0], normal_b[:, 1])
    weight = np.clip((bend - STRAIGHT_RAD) / (BENT_RAD - STRAIGHT_RAD), 0.0, 1.0)
    weight = weight * weight * (3.0 - 2.0 * weight)
    straightened = np.where(np.abs(twist) > 0.5 * np.pi, 0.0, weight)
    z_axis = np.array([0.0, 0.0, 1.0])
    turns[upper] = rotations.multiply(turns[upper], rotations.from_axis_angle(z_axis, straightened * twist))


def _joint_angles(turns: dict[str, np.ndarray]) -> np.ndarray:
    """Return all hinge angles ``(T, 35)``, within their limits; bodies without a source stay straight."""
    count = len(turns["pelvis"])
    angles = np.zeros((count, len(HUMANOID.joint_names)))
    local = _local_rotations(turns)
    first = 0
    for body in BODIES:
        size = len(body.hinges)
        if body.name in local:
            axes = [int(np.argmax(hinge.axis)) for hinge in body.hinges]
            angles[:, first : first + size] = _angles_of(local[body.name], axes)
        first += size
    for column in range(angles.shape[1]):
        angles[:, column] = _within_limits(angles[:, column], column)
    return angles


def _local_rotations(turns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return each mapped body's rotation against the nearest mapped body above it."""
    parents = {body.name: body.parent for body in BODIES}
    local = {}
    for name, turn in turns.items():
        above = parents[name]
        while above is not None and above not in turns:
            above = parents[above]
        if above is not None:
            local[name] = rotations.multiply(rotations.conjugate(turns[above]), turn)
    half = rotations.from_rotation_vector(0.5 * rotations.to_rotation_vector(local["chest"]))
    local["abdomen"] = local["chest"] = half
    return local


def _angles_of(quat: np.ndarray, axes: list[int]) -> np.ndarray:
    if len(axes) == 1:
        return hinge_angle(quat, axes[0])[:, None]
    rest = [axis for axis in range(3) if axis not in axes]
    order = "".join("XYZ"[axis] for axis in axes + rest)
    return hinge_angles(quat, order)[:, : len(axes)]


def _within_limits(angles: np.ndarray, joint: int) -> np.ndarray:
    """Return the angles shifted by whole turns to the middle of the hinge's range, then cut off at it."""
    lower, upper = HUMANOID.joint_lower[joint], HUMANOID.joint_upper[joint]
    turns = np.round((np.median(angles) - 0.5 * (lower + upper)) / (2 * np.pi))
    return np.clip(angles - 2 * np.pi * turns, lower, upper)


def _leg_ratio(motion: SourceMotion, mapping: Mapping) -> float:
    """Return our legs' length over the source's."""
    rest = motion.rest_positions()
    names = [mapping.joints[f"left_{part}"] for part in ("thigh", "shin", "foot")]
    hip, knee, ankle = (rest[motion.joint_names.index(name)] for name in names)
    source = np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)
    names_ours = [f"left_{part}" for part in ("shin", "foot")]
    ours = sum(np.linalg.norm(HUMANOID.offsets[HUMANOID.body_names.index(name)]) for name in names_ours)
    return float(ours / source)


def _put_on_floor(clip: Clip) -> Clip:
    root_pos = clip.frames.root_pos_w.copy()
    root_pos[:, 2] += height_correction(lowest_point(clip.frames))
    return clip_from_poses(
        clip.name,
        root_pos,
        clip.frames.root_quat_w.copy(),
        clip.frames.joint_pos.copy(),
        source=clip.source,
        licence=clip.licence,
        label=clip.label,
    )
