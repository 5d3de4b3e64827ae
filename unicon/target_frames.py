"""Target messages as they come from outside, and the check that lets only sound ones through.

A raw message may hold anything: arrays of any length, NaN, numbers without measure. `check` turns it into
`TargetFrames`, on which everything else may rely, or says why it is refused. Cheap tests come first, so
that a hostile message costs little.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.state import CharacterState

JOINTS = len(HUMANOID.joint_names)
FRAME_SIZE = 3 + 4 + 3 + 3 + 2 * JOINTS
NS_PER_S = 1_000_000_000


class RejectReason(StrEnum):
    """Why a target message was refused."""

    BAD_SOURCE = "bad_source"
    WRONG_HUMANOID = "wrong_humanoid"
    NO_FRAMES = "no_frames"
    TOO_MANY_FRAMES = "too_many_frames"
    BAD_INTERVAL = "bad_interval"
    BAD_TIME = "bad_time"
    WRONG_LENGTH = "wrong_length"
    NOT_FINITE = "not_finite"
    NOT_UNIT_QUATERNION = "not_unit_quaternion"
    OUT_OF_RANGE = "out_of_range"
    OLD_SEQUENCE = "old_sequence"


class RejectedTargetsError(UniconError):
    """A target message was refused; ``reason`` says by which rule."""

    def __init__(self, reason: RejectReason, detail: str) -> None:
        super().__init__(f"target message refused ({reason.value}): {detail}")
        self.reason = reason


@dataclass(frozen=True)
class RawFrame:
    """One frame as it came; the arrays may have any length."""

    root_pos_w: np.ndarray
    root_quat_w: np.ndarray
    """w, x, y, z."""
    root_lin_vel_w: np.ndarray
    root_ang_vel_w: np.ndarray
    joint_pos: np.ndarray
    joint_vel: np.ndarray


@dataclass(frozen=True)
class RawTargetFrames:
    """A target message as it came."""

    source: str
    sequence: int
    humanoid_id: str
    time_ns: int
    """Time of the first frame."""
    interval_s: float
    frames: Sequence[RawFrame]


@dataclass(frozen=True)
class TargetFrames:
    """A sound target message: F frames at rising times."""

    source: str
    sequence: int
    times_ns: np.ndarray
    """``(F,)`` int64."""
    frames: CharacterState
    """Batch ``(F,)``."""


@dataclass(frozen=True)
class TargetLimits:
    """What a sound message may hold."""

    max_frames: int = 64
    max_source_length: int = 64
    min_interval_s: float = 0.001
    max_interval_s: float = 1.0
    max_ahead_s: float = 60.0
    """How far the first frame may lie after the last tick."""
    max_behind_s: float = 1.0
    """How far the last frame may lie before the last tick."""
    unit_tolerance: float = 1e-3
    """How far a quaternion's length may be from 1."""
    max_position_m: float = 1e4
    min_height_m: float = -1.0
    """Lowest root; below the floor there is nothing to stand on."""
    max_height_m: float = 20.0
    max_speed_m_s: float = 100.0
    max_spin_rad_s: float = 200.0
    max_angle_rad: float = 4 * np.pi
    """Largest hinge angle."""


FIELD_SIZES = (3, 4, 3, 3, JOINTS, JOINTS)
_COLUMNS = np.cumsum((0, *FIELD_SIZES))


def check(raw: RawTargetFrames, now_ns: int | None, limits: TargetLimits) -> TargetFrames:
    """Return the message as sound frames; ``now_ns`` is the time of the last tick, if there was one.

    Raises:
        RejectedTargetsError: when a rule is broken; nothing of the message may be used.
    """
    _check_header(raw, limits)
    _check_time(raw, now_ns, limits)
    matrix = _gather(raw.frames)
    _check_numbers(matrix, limits)
    quat = matrix[:, 3:7]
    matrix[:, 3:7] = quat / np.linalg.norm(quat, axis=1, keepdims=True)
    steps = np.arange(len(matrix)) * (raw.interval_s * NS_PER_S)
    times_ns = raw.time_ns + np.rint(steps).astype(np.int64)
    return TargetFrames(raw.source, raw.sequence, times_ns, unpack(matrix))


def pack(frames: CharacterState) -> np.ndarray:
    """Return states ``(...)`` as rows ``(..., 83)`` in the order of the fields."""
    return np.concatenate(list(vars(frames).values()), axis=-1)


def unpack(rows: np.ndarray) -> CharacterState:
    """Return rows ``(..., 83)`` as states ``(...)``, as views."""
    spans = zip(_COLUMNS[:-1], _COLUMNS[1:], strict=True)
    return CharacterState(*(rows[..., first:last] for first, last in spans))


def _refuse(reason: RejectReason, detail: str) -> RejectedTargetsError:
    return RejectedTargetsError(reason, detail)


def _check_header(raw: RawTargetFrames, limits: TargetLimits) -> None:
    if not 1 <= len(raw.source) <= limits.max_source_length:
        length = f"its source has {len(raw.source)} characters, expected 1 to {limits.max_source_length}"
        raise _refuse(RejectReason.BAD_SOURCE, length)
    if raw.humanoid_id != HUMANOID.id:
        other = f"it is for humanoid {raw.humanoid_id[:64]!r}, this is {HUMANOID.id!r}"
        raise _refuse(RejectReason.WRONG_HUMANOID, other)
    if not len(raw.frames):
        raise _refuse(RejectReason.NO_FRAMES, "it has no frames")
    if len(raw.frames) > limits.max_frames:
        many = f"it has {len(raw.frames)} frames, at most {limits.max_frames} are allowed"
        raise _refuse(RejectReason.TOO_MANY_FRAMES, many)


def _check_time(raw: RawTargetFrames, now_ns: int | None, limits: TargetLimits) -> None:
    if not limits.min_interval_s <= raw.interval_s <= limits.max_interval_s:
        allowed = f"expected {limits.min_interval_s} to {limits.max_interval_s} s"
        raise _refuse(RejectReason.BAD_INTERVAL, f"its interval is {raw.interval_s} s, {allowed}")
    if not 0 <= raw.time_ns < 2**62:
        raise _refuse(RejectReason.BAD_TIME, f"its time {raw.time_ns} ns is no time")
    if now_ns is None:
        return
    ahead_s = (raw.time_ns - now_ns) / NS_PER_S
    behind_s = -ahead_s - (len(raw.frames) - 1) * raw.interval_s
    if ahead_s > limits.max_ahead_s or behind_s > limits.max_behind_s:
        raise _refuse(RejectReason.BAD_TIME, f"its first frame lies {ahead_s:+.3f} s from now")


def _gather(frames: Sequence[RawFrame]) -> np.ndarray:
    """Return the frames as rows ``(F, 83)``, refusing arrays of other lengths."""
    rows = np.empty((len(frames), FRAME_SIZE))
    for row, frame in zip(rows, frames, strict=True):
        arrays = zip(vars(frame).items(), FIELD_SIZES, _COLUMNS[:-1], strict=True)
        for (name, value), size, start in arrays:
            if len(value) != size:
                wrong = f"{name} has {len(value)} numbers, expected {size}"
                raise _refuse(RejectReason.WRONG_LENGTH, wrong)
            row[start : start + size] = value
    return rows


def _check_numbers(rows: np.ndarray, limits: TargetLimits) -> None:
    if not np.isfinite(rows).all():
        raise _refuse(RejectReason.NOT_FINITE, "it has a number that is not finite")
    pos, quat, lin_vel, ang_vel, joint_pos, joint_vel = vars(unpack(rows)).values()
    bounds = (
        ("root position", pos, limits.max_position_m, "m"),
        ("root velocity", lin_vel, limits.max_speed_m_s, "m/s"),
        ("root angular velocity", ang_vel, limits.max_spin_rad_s, "rad/s"),
        ("joint angle", joint_pos, limits.max_angle_rad, "rad"),
        ("joint velocity", joint_vel, limits.max_spin_rad_s, "rad/s"),
        ("quaternion", quat, 2.0, ""),
    )
    for name, values, bound, unit in bounds:
        largest = np.abs(values).max()
        if largest > bound:
            far = f"a {name} is {largest:.3g} {unit}, at most {bound:.4g} is allowed"
            raise _refuse(RejectReason.OUT_OF_RANGE, far)
    lowest, highest = pos[:, 2].min(), pos[:, 2].max()
    if lowest < limits.min_height_m or highest > limits.max_height_m:
        allowed = f"expected {limits.min_height_m} to {limits.max_height_m} m"
        raise _refuse(RejectReason.OUT_OF_RANGE, f"a root's height is {lowest:.4g} m, {allowed}")
    length = np.linalg.norm(quat, axis=1)
    if np.abs(length - 1.0).max() > limits.unit_tolerance:
        off = f"a root quaternion has the length {length[np.abs(length - 1).argmax()]:.4f}, expected 1"
        raise _refuse(RejectReason.NOT_UNIT_QUATERNION, off)
