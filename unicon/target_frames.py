"""Target frames as they arrive, and the checks that they pass before anything else sees them.

A scheduler may be anybody's program, so nothing about a message is trusted: the cheap facts are looked
at first (names and counts), then all numbers of all frames at once. A message that breaks one rule is
dropped whole. What depends on time or on earlier messages (``BAD_TIME`` against the present tick,
``OLD_SEQUENCE``) is judged where it is known, in ``unicon.target_sources``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID, Humanoid
from unicon.state import CharacterState

MAX_FRAMES = 64
MAX_SOURCE_LENGTH = 64
MAX_SEQUENCE = 2**64 - 1
MAX_TIME_NS = 2**62
"""Latest time that a message may name [ns]; sums of such times still fit into 64 bits."""
NS_PER_S = 1_000_000_000


class RejectReason(StrEnum):
    """Why a target message was dropped; counted by these names in status and diagnostics."""

    NOT_FINITE = "not_finite"
    """A number of a frame is infinite, not a number, or no number at all."""
    WRONG_JOINT_COUNT = "wrong_joint_count"
    """An array of a frame has the wrong length: 35 joints, 3 for vectors, 4 for the quaternion."""
    WRONG_HUMANOID = "wrong_humanoid"
    """The frames were made for another humanoid."""
    NOT_UNIT_QUATERNION = "not_unit_quaternion"
    """A root rotation's length is not 1."""
    OLD_SEQUENCE = "old_sequence"
    """The source has already sent this sequence number or a later one, or it is no 64-bit number."""
    NO_FRAMES = "no_frames"
    """The message is empty."""
    TOO_MANY_FRAMES = "too_many_frames"
    """More than 64 frames."""
    BAD_INTERVAL = "bad_interval"
    """The time between frames is not within 1 ms to 1 s."""
    BAD_TIME = "bad_time"
    """The frames lie too far in the past or the future, or before the epoch."""
    OUT_OF_RANGE = "out_of_range"
    """A position, speed or angle is absurd, though finite."""
    BAD_SOURCE = "bad_source"
    """The source's name is empty, too long or not printable, or there are too many live sources."""
    OVERFLOW = "overflow"
    """Too many messages came before the next tick; the oldest ones gave way."""


class RejectedTargets(Exception):
    """A target message broke a rule; it is dropped and counted, never shown as an error."""

    def __init__(self, reason: RejectReason, detail: str) -> None:
        super().__init__(f"{reason}: {detail}")
        self.reason = reason
        self.detail = detail


@dataclass(frozen=True)
class TargetLimits:
    """What is still believable of a person; wide, since they only stop nonsense."""

    position_m: float = 1e4
    """Largest horizontal coordinate of the root [m]."""
    lowest_root_m: float = -1.0
    """Lowest height of the root [m]; the floor is at 0."""
    highest_root_m: float = 10.0
    """Greatest height of the root [m]."""
    speed_m_s: float = 100.0
    """Largest component of the root's velocity [m/s]."""
    spin_rad_s: float = 200.0
    """Largest component of the root's angular velocity, and largest hinge velocity [rad/s]."""
    angle_rad: float = 4.0 * math.pi
    """Largest hinge angle [rad]."""
    unit_tolerance: float = 1e-3
    """How far a quaternion's length may be from 1; within it, it is normalised."""
    shortest_interval_s: float = 0.001
    """Shortest time between frames [s]."""
    longest_interval_s: float = 1.0
    """Longest time between frames [s]."""
    oldest_s: float = 10.0
    """A message whose last frame lies this long before the present tick is dropped [s]."""
    furthest_s: float = 60.0
    """A message whose first frame lies this long after the present tick is dropped [s]."""


class RawFrame(NamedTuple):
    """One frame as it came: nothing is known about the arrays, not even their lengths."""

    root_pos_w: Any
    """Should be ``(3,)`` [m]."""
    root_quat_w: Any
    """Should be ``(4,)``, w x y z."""
    root_lin_vel_w: Any
    """Should be ``(3,)`` [m/s]."""
    root_ang_vel_w: Any
    """Should be ``(3,)`` [rad/s]."""
    joint_pos: Any
    """Should be ``(35,)`` [rad]."""
    joint_vel: Any
    """Should be ``(35,)`` [rad/s]."""


class RawTargetFrames(NamedTuple):
    """One message of a scheduler as it came."""

    source: str
    """Who publishes."""
    sequence: int
    """Rises with each message of a source."""
    humanoid_id: str
    """``Humanoid.id`` of the humanoid that the frames are for."""
    time_ns: int
    """Time of the first frame [ns]."""
    interval_s: float
    """Time from one frame to the next [s]."""
    frames: Sequence[RawFrame]
    """One or more frames in the order of their times."""


@dataclass(frozen=True)
class TargetFrames:
    """A checked message: finite, in range, right lengths, unit quaternions."""

    source: str
    """Who publishes."""
    sequence: int
    """Rises with each message of a source."""
    times_ns: np.ndarray
    """Times of the frames ``(F,)`` int64 [ns], rising."""
    frames: CharacterState
    """The frames, a batch ``(F,)`` of read-only arrays."""


def check(
    raw: RawTargetFrames,
    humanoid: Humanoid = HUMANOID,
    limits: TargetLimits = TargetLimits(),  # noqa: B008 - frozen, so shared safely
) -> TargetFrames:
    """Return the message as arrays of known shape, or refuse it.

    Raises:
        RejectedTargets: with the reason; never anything else, whatever the message holds.
    """
    count = _check_names_and_counts(raw, humanoid)
    interval_ns = _checked_interval_ns(raw.interval_s, limits)
    time_ns = _checked_time_ns(raw.time_ns)
    frames = _unpack(_pack(raw.frames, count, len(humanoid.joint_names)))
    _check_ranges(frames, limits)
    return TargetFrames(
        source=raw.source,
        sequence=int(raw.sequence),
        times_ns=time_ns + interval_ns * np.arange(count, dtype=np.int64),
        frames=_with_unit_quaternions(frames, limits),
    )


def to_raw(
    source: str,
    sequence: int,
    time_ns: int,
    interval_s: float,
    frames: CharacterState,
    humanoid: Humanoid = HUMANOID,
) -> RawTargetFrames:
    """Return the message that a scheduler would send for ``frames``, a batch ``(F,)``."""
    raw = [RawFrame(*vars(frames[i]).values()) for i in range(frames.batch_shape[0])]
    return RawTargetFrames(source, sequence, humanoid.id, time_ns, interval_s, raw)


def is_source_name(name: object) -> bool:
    """Say whether ``name`` may name a source: 1 to 64 printable characters."""
    return isinstance(name, str) and 0 < len(name) <= MAX_SOURCE_LENGTH and name.isprintable()


def _check_names_and_counts(raw: RawTargetFrames, humanoid: Humanoid) -> int:
    """Do what costs nothing first; return the number of frames."""
    if not is_source_name(raw.source):
        raise RejectedTargets(RejectReason.BAD_SOURCE, "a source has 1 to 64 printable characters")
    if raw.humanoid_id != humanoid.id:
        raise RejectedTargets(RejectReason.WRONG_HUMANOID, f"expected {humanoid.id}")
    if not (_is_integer(raw.sequence) and 0 <= raw.sequence <= MAX_SEQUENCE):
        raise RejectedTargets(RejectReason.OLD_SEQUENCE, "a sequence is a number of 64 bits")
    try:
        count = len(raw.frames)
    except TypeError:
        raise RejectedTargets(RejectReason.NO_FRAMES, "the frames are no sequence") from None
    if count == 0:
        raise RejectedTargets(RejectReason.NO_FRAMES, "the message is empty")
    if count > MAX_FRAMES:
        raise RejectedTargets(RejectReason.TOO_MANY_FRAMES, f"{count} frames, at most {MAX_FRAMES}")
    return count


def _is_integer(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _checked_interval_ns(interval_s: object, limits: TargetLimits) -> int:
    valid = isinstance(interval_s, int | float) and not isinstance(interval_s, bool)
    if not (valid and limits.shortest_interval_s <= interval_s <= limits.longest_interval_s):
        raise RejectedTargets(RejectReason.BAD_INTERVAL, "an interval is 1 ms to 1 s")
    return round(interval_s * NS_PER_S)


def _checked_time_ns(time_ns: object) -> int:
    if not (_is_integer(time_ns) and 0 <= time_ns <= MAX_TIME_NS):
        raise RejectedTargets(RejectReason.BAD_TIME, f"a time is 0 to {MAX_TIME_NS} ns")
    return int(time_ns)


def _pack(frames: Sequence[RawFrame], count: int, joints: int) -> np.ndarray:
    """Copy all frames into one array ``(F, 13 + 2 joints)``, so that later checks see all at once."""
    lengths = (3, 4, 3, 3, joints, joints)
    packed = np.empty((count, sum(lengths)))
    try:
        for row, frame in zip(packed, frames, strict=True):
            start = 0
            for values, length in zip(frame, lengths, strict=True):
                if len(values) != length:
                    raise RejectedTargets(
                        RejectReason.WRONG_JOINT_COUNT, f"{len(values)} values instead of {length}"
                    )
                row[start : start + length] = values
                start += length
    except (TypeError, ValueError, OverflowError):
        raise RejectedTargets(RejectReason.NOT_FINITE, "a value is no number") from None
    if not np.isfinite(packed).all():
        raise RejectedTargets(RejectReason.NOT_FINITE, "a value is infinite or not a number")
    return packed


def _unpack(packed: np.ndarray) -> CharacterState:
    joints = (packed.shape[-1] - 13) // 2
    return CharacterState(*np.split(packed, [3, 7, 10, 13, 13 + joints], axis=-1))


def _check_ranges(frames: CharacterState, limits: TargetLimits) -> None:
    height = frames.root_pos_w[:, 2]
    within = (
        abs(frames.root_pos_w[:, :2]).max() <= limits.position_m
        and limits.lowest_root_m <= height.min()
        and height.max() <= limits.highest_root_m
        and abs(frames.root_lin_vel_w).max() <= limits.speed_m_s
        and abs(frames.root_ang_vel_w).max() <= limits.spin_rad_s
        and abs(frames.joint_pos).max() <= limits.angle_rad
        and abs(frames.joint_vel).max() <= limits.spin_rad_s
    )
    if not within:
        raise RejectedTargets(RejectReason.OUT_OF_RANGE, "a position, speed or angle is absurd")


def _with_unit_quaternions(frames: CharacterState, limits: TargetLimits) -> CharacterState:
    """Normalise the root rotations; the other arrays are passed on."""
    quat = frames.root_quat_w
    # Components beyond 2 cannot belong to a unit quaternion, and their squares might overflow.
    if abs(quat).max() > 2.0:
        raise RejectedTargets(RejectReason.NOT_UNIT_QUATERNION, "a component is larger than 2")
    length = np.sqrt((quat * quat).sum(axis=-1))
    if abs(length - 1.0).max() > limits.unit_tolerance:
        raise RejectedTargets(RejectReason.NOT_UNIT_QUATERNION, "a root rotation's length is not 1")
    fields = vars(frames) | {"root_quat_w": rotations.normalize(quat)}
    for values in fields.values():
        values.flags.writeable = False
    return CharacterState(**fields)
