"""What the executor tells the world: state, events, status, and the same in standard messages."""

from __future__ import annotations

import json
from collections.abc import Mapping

from geometry_msgs.msg import PoseWithCovariance, TwistWithCovariance
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.urdf import build_urdf
from unicon.tracking import TickReport
from unicon_msgs.msg import CharacterState, ExecutorEvent, ExecutorStatus, HumanoidDescription
from unicon_ros.conversion import (
    WORLD_FRAME,
    to_array,
    to_description,
    to_point,
    to_quaternion,
    to_stamp,
    to_state_message,
    to_vector,
)
from unicon_ros.markers import HumanoidMarkers
from unicon_ros.qos import COMMAND, EVENTS, LATCHED, STREAM

ROOT_FRAME = "base_link"
TICKS_PER_S = 60


class ExecutorPublishers:
    """All topics of the executor."""

    def __init__(self, node: Node, markers_hz: float, lockstep: bool) -> None:
        reliable = COMMAND if lockstep else STREAM
        self._state = node.create_publisher(CharacterState, "state", reliable)
        self._joint_states = node.create_publisher(JointState, "joint_states", STREAM)
        self._odom = node.create_publisher(Odometry, "odom", STREAM)
        self._markers = node.create_publisher(MarkerArray, "markers", STREAM)
        self._events = node.create_publisher(ExecutorEvent, "events", EVENTS)
        self._status = node.create_publisher(ExecutorStatus, "status", LATCHED)
        self._clock = node.create_publisher(Clock, "/clock", STREAM) if lockstep else None
        self._latched = [
            (node.create_publisher(HumanoidDescription, "humanoid", LATCHED), to_description()),
            (
                node.create_publisher(String, "robot_description", LATCHED),
                String(data=build_urdf()),
            ),
        ]
        for publisher, message in self._latched:
            publisher.publish(message)
        self._marker_period = round(TICKS_PER_S / markers_hz) if markers_hz > 0 else 0
        self._humanoid_markers = HumanoidMarkers()
        self._joint_message = JointState(name=list(HUMANOID.joint_names))

    def publish_state(self, report: TickReport, target_age_s: float) -> None:
        """Publish a tick."""
        self._state.publish(to_state_message(report, target_age_s))

    def publish_views(self, report: TickReport) -> None:
        """Publish the same tick in standard messages; there is no hurry."""
        self._publish_joint_states(report)
        self._publish_odometry(report)
        due = self._marker_period and report.tick % self._marker_period == 0
        if due and self._markers.get_subscription_count():
            self._markers.publish(self._humanoid_markers.place(report.actual, report.time_ns))
        if self._clock is not None:
            self._clock.publish(Clock(clock=to_stamp(report.time_ns)))

    def publish_event(self, time_ns: int, tick: int, kind: str, arguments: str) -> None:
        """Publish a command that was applied before a tick."""
        event = ExecutorEvent(tick=tick, kind=kind, arguments=arguments)
        event.header.stamp = to_stamp(time_ns)
        event.header.frame_id = WORLD_FRAME
        self._events.publish(event)

    def publish_start(self, time_ns: int, settings: Mapping[str, object]) -> None:
        """Publish the event that begins every recording."""
        self.publish_event(time_ns, 0, "start", json.dumps(settings))

    def publish_status(self, status: ExecutorStatus) -> None:
        """Publish how the executor is doing."""
        self._status.publish(status)

    def _publish_joint_states(self, report: TickReport) -> None:
        message = self._joint_message
        message.header.stamp = to_stamp(report.time_ns)
        message.position = to_array(report.actual.joint_pos)
        message.velocity = to_array(report.actual.joint_vel)
        message.effort = to_array(report.torque)
        self._joint_states.publish(message)

    def _publish_odometry(self, report: TickReport) -> None:
        """The pose is the truth, in the world; the twist is in the root's frame, as REP 105 wants it."""
        state = report.actual
        pose, twist = PoseWithCovariance(), TwistWithCovariance()
        pose.pose.position = to_point(state.root_pos_w)
        pose.pose.orientation = to_quaternion(state.root_quat_w)
        quat = state.root_quat_w
        twist.twist.linear = to_vector(rotations.rotate_inverse(quat, state.root_lin_vel_w))
        twist.twist.angular = to_vector(rotations.rotate_inverse(quat, state.root_ang_vel_w))
        message = Odometry(pose=pose, twist=twist, child_frame_id=ROOT_FRAME)
        message.header.stamp = to_stamp(report.time_ns)
        message.header.frame_id = WORLD_FRAME
        self._odom.publish(message)
