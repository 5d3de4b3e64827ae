"""Bags that tests write, with the real definitions of the messages and the real tracker."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.samples import START_NS, TICK_NS, message, swaying
from unicon.commands import Reset, ThrowProjectile, kind_of, to_json
from unicon.humanoid import HUMANOID
from unicon.projectile import Projectile
from unicon.recording.bag_writer import BagWriter, Topic
from unicon.recording.schema import full_definition, short_name
from unicon.state import CharacterState
from unicon.target_frames import NS_PER_S, RawTargetFrames
from unicon.tracking import TickReport, Tracker, TrackerConfig

ROOT = Path(__file__).parents[2]
STORE = get_typestore(Stores.ROS2_JAZZY)
for path in sorted((ROOT / "src/unicon_msgs/msg").glob("*.msg")):
    STORE.register(get_types_from_msg(path.read_text(), f"unicon_msgs/msg/{path.stem}"))

STANDARD = {
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "std_msgs/String": "string data\n",
}


def definition_of(name: str) -> str:
    if name in STANDARD:
        return STANDARD[name]
    return (ROOT / "src/unicon_msgs/msg" / f"{name.split('/')[1]}.msg").read_text()


def topic(name: str, type_name: str) -> Topic:
    text = full_definition(type_name, definition_of)
    return Topic(name, type_name, text, STORE.hash_rihs01(type_name), "[]")


def make(type_name: str, **fields: Any) -> Any:
    return STORE.types[type_name](**fields)


def header(time_ns: int) -> Any:
    stamp = make("builtin_interfaces/msg/Time", sec=time_ns // NS_PER_S, nanosec=time_ns % NS_PER_S)
    return make("std_msgs/msg/Header", stamp=stamp, frame_id="world")


def xyz(kind: str, values: np.ndarray) -> Any:
    x, y, z = values.tolist()
    return make(f"geometry_msgs/msg/{kind}", x=x, y=y, z=z)


def frame(state: Any) -> Any:
    w, x, y, z = state.root_quat_w.tolist()
    return make(
        "unicon_msgs/msg/CharacterFrame",
        root_position=xyz("Point", state.root_pos_w),
        root_orientation=make("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w),
        root_linear_velocity=xyz("Vector3", state.root_lin_vel_w),
        root_angular_velocity=xyz("Vector3", state.root_ang_vel_w),
        joint_positions=np.array(state.joint_pos),
        joint_velocities=np.array(state.joint_vel),
    )


def state_message(report: TickReport) -> Any:
    return make(
        "unicon_msgs/msg/CharacterState",
        header=header(report.time_ns),
        tick=report.tick,
        episode=report.episode,
        mode=int(report.mode),
        source=report.source,
        actual=frame(report.actual),
        target=frame(report.target),
        torques=report.torque,
        contact_forces=report.contact_force,
        reward_terms=np.array(report.reward_terms, dtype=float),
        target_age=0.01,
        accepted_sources=[source for source, _ in report.accepted],
        accepted_sequences=np.array([number for _, number in report.accepted], dtype=np.uint64),
        **{k: v for k, v in vars(STORE.types["unicon_msgs/msg/CharacterState"]).items() if k.isupper()},
    )


def targets_message(raw: RawTargetFrames) -> Any:
    return make(
        "unicon_msgs/msg/TargetFrames",
        header=header(raw.time_ns),
        source=raw.source,
        sequence=raw.sequence,
        humanoid_id=raw.humanoid_id,
        interval=raw.interval_s,
        frames=[frame(f) for f in raw.frames],
    )


def event_message(time_ns: int, tick: int, kind: str, arguments: str) -> Any:
    return make(
        "unicon_msgs/msg/ExecutorEvent", header=header(time_ns), tick=tick, kind=kind, arguments=arguments
    )


class SessionBag:
    """A bag as a recorder writes it, made from a tracker that really ran."""

    TOPICS = (
        ("/a/state", "unicon_msgs/msg/CharacterState"),
        ("/a/target_frames", "unicon_msgs/msg/TargetFrames"),
        ("/a/events", "unicon_msgs/msg/ExecutorEvent"),
    )

    def __init__(self, folder: Path) -> None:
        self.writer = BagWriter(folder)
        for name, type_name in self.TOPICS:
            self.writer.add_topic(topic(name, type_name))
        self._types = dict(self.TOPICS)

    def write(self, name: str, content: Any, time_ns: int) -> None:
        data = bytes(STORE.serialize_cdr(content, self._types[name]))
        self.writer.write(name, data, time_ns, time_ns)


def record_session(folder: Path, ticks: int = 120, spoil_tick: int = -1, first_target: int = 5) -> None:
    """Run a tracker through targets, a ball, a reset and gaps, and record it; one float may be spoilt."""
    bag, tracker = SessionBag(folder), Tracker()
    start = {"config": asdict(TrackerConfig()), "humanoid_id": HUMANOID.id}
    bag.write("/a/events", event_message(START_NS, 0, "start", json.dumps(start)), START_NS)
    path = swaying(ticks + 10)
    commands = {40: ThrowProjectile(Projectile()), 80: Reset("rest")}
    for tick in range(ticks):
        now = START_NS + tick * TICK_NS
        if tick in commands:
            tracker.apply(commands[tick])
            event = event_message(now, tick, kind_of(commands[tick]), to_json(commands[tick]))
            bag.write("/a/events", event, now)
        if tick >= first_target and (tick + 1) % 7:
            raw = message(tick, now + TICK_NS, path[tick], path[tick + 1])
            tracker.offer(raw)
            bag.write("/a/target_frames", targets_message(raw), now)
        report = tracker.tick(now)
        if tick == spoil_tick:
            spoilt = np.nextafter(report.actual.joint_pos, 1.0)
            report = report._replace(actual=CharacterState(**{**vars(report.actual), "joint_pos": spoilt}))
        bag.write("/a/state", state_message(report), now)
    bag.writer.close({"state": "all"})


__all__ = ["STORE", "SessionBag", "definition_of", "record_session", "short_name", "topic"]
