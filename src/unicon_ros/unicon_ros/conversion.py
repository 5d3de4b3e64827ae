"""Messages to the library's dataclasses and back: the one place where x, y, z, w becomes w, x, y, z."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Quaternion, Vector3

from unicon.humanoid import HUMANOID
from unicon.state import CharacterState
from unicon.target_frames import NS_PER_S, RawFrame, RawTargetFrames
from unicon.tracking import TickReport
from unicon_msgs.msg import CharacterFrame, HumanoidDescription, TargetFrames
from unicon_msgs.msg import CharacterState as CharacterStateMessage

WORLD_FRAME = "world"


def to_stamp(time_ns: int) -> Time:
    """Return a time as a message."""
    return Time(sec=time_ns // NS_PER_S, nanosec=time_ns % NS_PER_S)


def from_stamp(stamp: Time) -> int:
    """Return a message's time in nanoseconds."""
    return stamp.sec * NS_PER_S + stamp.nanosec


def to_array(values: np.ndarray) -> array[float]:
    """Return floats as the array type that messages take without copying them one by one."""
    return array("d", np.ascontiguousarray(values, dtype=np.float64).tobytes())


def to_point(v: np.ndarray) -> Point:
    """Return ``(3,)`` as a point."""
    x, y, z = v.tolist()
    return Point(x=x, y=y, z=z)


def to_vector(v: np.ndarray) -> Vector3:
    """Return ``(3,)`` as a vector."""
    x, y, z = v.tolist()
    return Vector3(x=x, y=y, z=z)


def to_quaternion(q: np.ndarray) -> Quaternion:
    """Return ``(4,)`` w, x, y, z as a quaternion message."""
    w, x, y, z = q.tolist()
    return Quaternion(x=x, y=y, z=z, w=w)


def _from_xyz(v: Point | Vector3) -> np.ndarray:
    return np.array((v.x, v.y, v.z))


def _from_quaternion(q: Quaternion) -> np.ndarray:
    return np.array((q.w, q.x, q.y, q.z))


def to_frame(state: CharacterState) -> CharacterFrame:
    """Return one state as a message."""
    return CharacterFrame(
        root_position=to_point(state.root_pos_w),
        root_orientation=to_quaternion(state.root_quat_w),
        root_linear_velocity=to_vector(state.root_lin_vel_w),
        root_angular_velocity=to_vector(state.root_ang_vel_w),
        joint_positions=to_array(state.joint_pos),
        joint_velocities=to_array(state.joint_vel),
    )


def from_frame(frame: CharacterFrame) -> RawFrame:
    """Return one frame as it came, whatever its arrays' lengths."""
    return RawFrame(
        root_pos_w=_from_xyz(frame.root_position),
        root_quat_w=_from_quaternion(frame.root_orientation),
        root_lin_vel_w=_from_xyz(frame.root_linear_velocity),
        root_ang_vel_w=_from_xyz(frame.root_angular_velocity),
        joint_pos=np.asarray(frame.joint_positions),
        joint_vel=np.asarray(frame.joint_velocities),
    )


def to_state(frame: CharacterFrame) -> CharacterState:
    """Return one frame of a program that is trusted, e.g. the executor, as a state."""
    return CharacterState(**vars(from_frame(frame)))


class _LazyFrames(Sequence[RawFrame]):
    """Converts frames only when they are looked at, so that a message refused early costs nothing."""

    def __init__(self, frames: Sequence[CharacterFrame]) -> None:
        self._frames = frames

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, index: int) -> RawFrame:  # type: ignore[override]
        return from_frame(self._frames[index])


def from_target_frames(message: TargetFrames) -> RawTargetFrames:
    """Return a target message as it came; nothing in it is checked here."""
    return RawTargetFrames(
        source=message.source,
        sequence=message.sequence,
        humanoid_id=message.humanoid_id,
        time_ns=from_stamp(message.header.stamp),
        interval_s=message.interval,
        frames=_LazyFrames(message.frames),
    )


def to_target_frames(
    source: str, sequence: int, time_ns: int, interval_s: float, frames: CharacterState
) -> TargetFrames:
    """Return frames ``(F,)`` as a message."""
    message = TargetFrames(
        source=source,
        sequence=sequence,
        humanoid_id=HUMANOID.id,
        interval=interval_s,
        frames=[to_frame(frames[i]) for i in range(frames.batch_shape[0])],
    )
    message.header.stamp = to_stamp(time_ns)
    message.header.frame_id = WORLD_FRAME
    return message


def to_state_message(report: TickReport, target_age_s: float) -> CharacterStateMessage:
    """Return a tick's report as a message."""
    message = CharacterStateMessage(
        tick=report.tick,
        episode=report.episode,
        mode=int(report.mode),
        source=report.source,
        actual=to_frame(report.actual),
        target=to_frame(report.target),
        torques=to_array(report.torque),
        contact_forces=to_array(report.contact_force),
        reward_terms=to_array(np.array(report.reward_terms)),
        target_age=target_age_s,
        accepted_sources=[source for source, _ in report.accepted],
        accepted_sequences=array("Q", [sequence for _, sequence in report.accepted]),
    )
    message.header.stamp = to_stamp(report.time_ns)
    message.header.frame_id = WORLD_FRAME
    return message


def to_description() -> HumanoidDescription:
    """Return the humanoid as a message."""
    return HumanoidDescription(
        id=HUMANOID.id,
        height=HUMANOID.height_m,
        mass=float(HUMANOID.body_mass.sum()),
        body_names=list(HUMANOID.body_names),
        body_parents=[int(parent) for parent in HUMANOID.parents],
        body_masses=to_array(HUMANOID.body_mass),
        joint_names=list(HUMANOID.joint_names),
        joint_bodies=[int(body) for body in HUMANOID.joint_body],
        joint_lower=to_array(HUMANOID.joint_lower),
        joint_upper=to_array(HUMANOID.joint_upper),
        joint_efforts=to_array(HUMANOID.effort),
    )
