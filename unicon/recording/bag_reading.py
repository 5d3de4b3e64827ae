"""Reads a bag's states, target frames and events back, every float to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rosbags.highlevel import AnyReader, AnyReaderError

from unicon.errors import InputFileError
from unicon.recording.bag_writer import METADATA_FILE
from unicon.state import CharacterState
from unicon.target_frames import NS_PER_S, RawFrame, RawTargetFrames

TYPES = {
    "unicon_msgs/msg/CharacterState": "state",
    "unicon_msgs/msg/TargetFrames": "target_frames",
    "unicon_msgs/msg/ExecutorEvent": "event",
    "unicon_msgs/msg/ExecutorStatus": "status",
}


class RecordedState(NamedTuple):
    """One tick as it was published; the names are those of the message."""

    time_ns: int
    tick: int
    episode: int
    mode: int
    source: str
    actual: CharacterState
    target: CharacterState
    torque: np.ndarray
    contact_force: np.ndarray
    reward_terms: np.ndarray
    target_age_s: float
    accepted: tuple[tuple[str, int], ...]


class RecordedEvent(NamedTuple):
    """One command as it was published."""

    time_ns: int
    tick: int
    kind: str
    arguments: str


class Recording(NamedTuple):
    """What of a bag concerns one avatar, each in the order of recording."""

    states: list[RecordedState]
    targets: list[RawTargetFrames]
    events: list[RecordedEvent]
    statuses: list[Any]
    """ExecutorStatus messages, as rosbags reads them."""


@contextmanager
def open_bag(folder: Path) -> Iterator[AnyReader]:
    """Open a bag.

    Raises:
        InputFileError: when it is missing or damaged.
    """
    if not folder.is_dir():
        raise InputFileError(f"{folder}: there is no such bag; give the folder of a recording")
    if not (folder / METADATA_FILE).exists():
        raise InputFileError(f"{folder}: has no {METADATA_FILE}; mend it with `unicon bag repair {folder}`")
    try:
        reader = AnyReader([folder])
        reader.open()
    except (AnyReaderError, OSError, ValueError, KeyError, AssertionError) as error:
        raise InputFileError(f"{folder}: cannot be read as a bag ({error})") from error
    try:
        yield reader
    finally:
        reader.close()


def read_recording(folder: Path, kinds: tuple[str, ...] = tuple(TYPES.values())) -> Recording:
    """Read a bag of one avatar; ``kinds`` names what is wanted of the values of `TYPES`.

    Raises:
        InputFileError: when the bag cannot be read.
    """
    found: dict[str, list[Any]] = {kind: [] for kind in TYPES.values()}
    readers = {"state": _state, "target_frames": _targets, "event": _event, "status": _same}
    with open_bag(folder) as bag:
        wanted = [c for c in bag.connections if TYPES.get(c.msgtype) in kinds]
        for connection, _, raw in bag.messages(connections=wanted):
            kind = TYPES[connection.msgtype]
            found[kind].append(readers[kind](bag.deserialize(raw, connection.msgtype)))
    return Recording(found["state"], found["target_frames"], found["event"], found["status"])


def _same(message: Any) -> Any:
    return message


def _time_ns(message: Any) -> int:
    stamp = message.header.stamp
    return stamp.sec * NS_PER_S + stamp.nanosec


def _raw_frame(frame: Any) -> RawFrame:
    p, q = frame.root_position, frame.root_orientation
    v, w = frame.root_linear_velocity, frame.root_angular_velocity
    return RawFrame(
        root_pos_w=np.array((p.x, p.y, p.z)),
        root_quat_w=np.array((q.w, q.x, q.y, q.z)),
        root_lin_vel_w=np.array((v.x, v.y, v.z)),
        root_ang_vel_w=np.array((w.x, w.y, w.z)),
        joint_pos=np.asarray(frame.joint_positions),
        joint_vel=np.asarray(frame.joint_velocities),
    )


def _character(frame: Any) -> CharacterState:
    return CharacterState(*vars(_raw_frame(frame)).values())


def _state(message: Any) -> RecordedState:
    sequences = [int(number) for number in message.accepted_sequences]
    return RecordedState(
        time_ns=_time_ns(message),
        tick=int(message.tick),
        episode=int(message.episode),
        mode=int(message.mode),
        source=message.source,
        actual=_character(message.actual),
        target=_character(message.target),
        torque=np.asarray(message.torques),
        contact_force=np.asarray(message.contact_forces),
        reward_terms=np.asarray(message.reward_terms),
        target_age_s=float(message.target_age),
        accepted=tuple(zip(message.accepted_sources, sequences, strict=True)),
    )


def _targets(message: Any) -> RawTargetFrames:
    return RawTargetFrames(
        source=message.source,
        sequence=int(message.sequence),
        humanoid_id=message.humanoid_id,
        time_ns=_time_ns(message),
        interval_s=float(message.interval),
        frames=[_raw_frame(frame) for frame in message.frames],
    )


def _event(message: Any) -> RecordedEvent:
    return RecordedEvent(_time_ns(message), int(message.tick), message.kind, message.arguments)
