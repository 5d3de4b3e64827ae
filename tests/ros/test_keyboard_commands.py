"""Tests for which commands the keyboard scheduler takes, and what it counts."""

from __future__ import annotations

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, TwistStamped
from rclpy.action import ActionClient
from sensor_msgs.msg import Joy

from tests.ros.conftest import Graph
from unicon_msgs.action import GoTo
from unicon_msgs.msg import CharacterState, LocomotionCommand, TargetFrames
from unicon_msgs.srv import Reset
from unicon_ros.qos import COMMAND, STREAM_SUBSCRIBER

pytestmark = pytest.mark.ros


def test_stamped_twists_make_the_reference_go_where_the_parameter_says_so(graph: Graph):
    graph.start("unicon_schedulers", "keyboard_node", stamped="true")
    frames = graph.listen(TargetFrames, "target_frames", STREAM_SUBSCRIBER)
    publisher = graph.node.create_publisher(TwistStamped, "cmd_vel", COMMAND)
    twist = TwistStamped()
    twist.twist.linear.x = 1.2

    def goes() -> bool:
        publisher.publish(twist)
        return bool(frames) and frames[-1].frames[0].root_linear_velocity.x > 0.8

    graph.until(goes, "the reference walking")


def test_rejected_and_clamped_commands_are_counted_on_diagnostics(graph: Graph):
    graph.start("unicon_schedulers", "keyboard_node")
    heard = graph.listen(DiagnosticArray, "/diagnostics", COMMAND)
    commands = graph.node.create_publisher(LocomotionCommand, "locomotion_command", COMMAND)
    gamepad = graph.node.create_publisher(Joy, "joy", COMMAND)

    def counts() -> dict[str, str]:
        statuses = [s for array in heard for s in array.status if s.name == "/a/keyboard"]
        return {value.key: value.value for value in statuses[-1].values} if statuses else {}

    graph.until(lambda: counts().get("rejected") == "0", "a diagnosis")
    graph.until(
        lambda: commands.get_subscription_count() and gamepad.get_subscription_count(), "its subscriptions"
    )
    commands.publish(LocomotionCommand(left=math.inf))
    commands.publish(LocomotionCommand(face=True, facing=math.nan))
    gamepad.publish(Joy(axes=[0.0, math.nan], buttons=[]))
    commands.publish(LocomotionCommand(turn_rate=99.0))
    graph.until(lambda: counts()["rejected"] == "3" and counts()["clamped"] == "1", "the counts")


def test_a_reset_of_the_avatar_ends_a_go_to_and_says_so(graph: Graph):
    graph.start("unicon_executor", "executor_node", policy="reference_servo")
    node = graph.start("unicon_schedulers", "keyboard_node")
    states = graph.listen(CharacterState, "state", STREAM_SUBSCRIBER)
    client = ActionClient(graph.node, GoTo, "keyboard/go_to")
    graph.until(lambda: states and states[-1].source == "keyboard", "the executor following")
    graph.until(client.server_is_ready, "the action")
    heard: list[object] = []
    future = client.send_goal_async(GoTo.Goal(position=Point(x=30.0)), feedback_callback=heard.append)
    # ten times a second: by the fifth it knows which episode it is in
    graph.until(lambda: future.done() and len(heard) > 4, "the way there")
    result = future.result().get_result_async()
    graph.call(Reset, "executor/reset")
    graph.until(result.done, "the end of the go-to")
    assert result.result().result.message == "the avatar was reset"
    assert "the avatar was reset" in node.output.read_text()
