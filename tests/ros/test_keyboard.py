"""Tests for the keyboard scheduler and its terminal program as real processes."""

from __future__ import annotations

import math
import os
import pty
import signal
import subprocess
import termios
import time
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix
from geometry_msgs.msg import Point, Twist
from rclpy.action import ActionClient
from sensor_msgs.msg import Joy

from tests.ros.conftest import Graph, end
from unicon_msgs.action import GoTo
from unicon_msgs.msg import CharacterState, ExecutorStatus, LocomotionCommand, SchedulerStatus, TargetFrames
from unicon_ros.qos import COMMAND, LATCHED, STREAM_SUBSCRIBER

pytestmark = pytest.mark.ros
TELEOP = Path(get_package_prefix("unicon_schedulers")) / "lib/unicon_schedulers/teleop_keyboard"


def forward_speed(frames: list[TargetFrames]) -> float:
    """Return how fast the newest target goes along the ground."""
    velocity = frames[-1].frames[0].root_linear_velocity
    return math.hypot(velocity.x, velocity.y)


def test_twists_make_the_reference_go_and_silence_makes_it_stand(graph: Graph):
    graph.start("unicon_executor", "executor_node", policy="reference_servo")
    node = graph.start("unicon_schedulers", "keyboard_node")
    frames = graph.listen(TargetFrames, "target_frames", STREAM_SUBSCRIBER)
    plays = graph.listen(SchedulerStatus, "keyboard/status", LATCHED)
    statuses = graph.listen(ExecutorStatus, "status", LATCHED)
    publisher = graph.node.create_publisher(Twist, "cmd_vel", COMMAND)
    graph.until(lambda: frames and forward_speed(frames) == 0.0, "a standing reference")
    following = CharacterState.FOLLOWING
    graph.until(lambda: statuses and statuses[-1].mode == following, "the executor following")
    assert statuses[-1].source == "keyboard"
    twist = Twist()
    twist.linear.x, twist.angular.z = 1.2, 0.4

    def goes() -> bool:
        publisher.publish(twist)
        return forward_speed(frames) > 0.8 and plays[-1].playing == "walk"

    graph.until(goes, "the reference walking")
    graph.until(lambda: forward_speed(frames) == 0.0, "the reference standing again")
    assert end(node) == 0


def test_what_is_no_number_is_rejected_and_too_much_is_clamped(graph: Graph):
    node = graph.start("unicon_schedulers", "keyboard_node")
    frames = graph.listen(TargetFrames, "target_frames", STREAM_SUBSCRIBER)
    publisher = graph.node.create_publisher(LocomotionCommand, "locomotion_command", COMMAND)
    graph.until(lambda: frames and publisher.get_subscription_count(), "the node")
    publisher.publish(LocomotionCommand(forward=math.nan))
    publisher.publish(LocomotionCommand(forward=1.0, gait="hop"))
    publisher.publish(LocomotionCommand(forward=99.0))
    graph.until(lambda: "more than was trained: speed 99" in node.output.read_text(), "a warning")
    text = node.output.read_text()
    assert "rejected: a locomotion command holds (nan" in text
    assert end(node) == 0


def test_a_gamepad_steers_it(graph: Graph):
    graph.start("unicon_schedulers", "keyboard_node")
    frames = graph.listen(TargetFrames, "target_frames", STREAM_SUBSCRIBER)
    publisher = graph.node.create_publisher(Joy, "joy", COMMAND)

    def goes() -> bool:
        publisher.publish(Joy(axes=[0.0, 1.0, 0.0, 0.0], buttons=[0] * 8))
        return bool(frames) and forward_speed(frames) > 0.8

    graph.until(goes, "the reference walking")


def test_it_goes_to_a_place_says_how_far_it_is_and_can_be_called_back(graph: Graph):
    graph.start("unicon_schedulers", "keyboard_node")
    client = ActionClient(graph.node, GoTo, "keyboard/go_to")
    graph.until(client.server_is_ready, "the action")
    heard: list[GoTo.Feedback] = []

    def ask(goal: GoTo.Goal):
        future = client.send_goal_async(goal, feedback_callback=lambda m: heard.append(m.feedback))
        graph.until(future.done, "an answer to the goal")
        return future.result()

    goal = GoTo.Goal(position=Point(x=1.5, y=0.5), face=True, facing=1.0)
    result = ask(goal).get_result_async()
    graph.until(result.done, "the arrival", 30.0)
    assert result.result().result.success
    assert result.result().result.distance < 0.3
    assert heard[0].distance > heard[-1].distance
    accepted = ask(GoTo.Goal(position=Point(x=9.0)))
    cancelled = accepted.cancel_goal_async()
    graph.until(cancelled.done, "an answer to the cancel")
    result = accepted.get_result_async()
    graph.until(result.done, "the cancelled goal's result")
    assert not result.result().result.success
    assert result.result().result.message == "cancelled"
    assert not ask(GoTo.Goal(position=Point(x=math.nan))).accepted


class Typist:
    """The teleop in a terminal of its own, and somebody who types."""

    def __init__(self, graph: Graph) -> None:
        self.side, other = pty.openpty()
        self.before = termios.tcgetattr(self.side)
        command = [str(TELEOP), "--ros-args", "-r", "__ns:=/a"]
        self.process = subprocess.Popen(
            command, env=graph.environment, stdin=other, stdout=other, stderr=other, start_new_session=True
        )
        os.close(other)
        os.set_blocking(self.side, False)
        self.shown = ""

    def type(self, keys: str) -> None:
        os.write(self.side, keys.encode())

    def look(self) -> str:
        try:
            self.shown += os.read(self.side, 65536).decode(errors="replace")
        except BlockingIOError:
            pass
        return self.shown


@pytest.fixture
def typist(graph: Graph):
    made = Typist(graph)
    yield made
    made.process.kill()
    made.process.wait()
    os.close(made.side)


def test_typed_keys_become_commands_and_the_terminal_is_as_before(graph: Graph, typist: Typist):
    commands = graph.listen(LocomotionCommand, "locomotion_command", COMMAND)
    graph.until(lambda: "stands | walk 1.20 m/s" in typist.look(), "the banner and the line")
    assert "turn left" in typist.shown
    assert not termios.tcgetattr(typist.side)[3] & termios.ICANON

    def types_until(keys: str, done) -> None:
        def step() -> bool:
            typist.type(keys)
            typist.look()
            return bool(commands) and done(commands[-1])

        graph.until(step, f"a command for {keys!r}")

    types_until("w", lambda c: c.forward == pytest.approx(1.2))
    types_until("\x1b[D", lambda c: c.turn_rate > 0.5)
    typist.type("x\x1b")
    typist.type("[C")
    graph.until(lambda: commands[-1].turn_rate < 0.0, "a turn by an arrow in two pieces")
    typist.type("x")
    graph.until(lambda: commands[-1].forward == 0.0 and commands[-1].turn_rate == 0.0, "a stop")
    graph.until(lambda: "stands | walk" in typist.look()[-60:], "the line that it stands")
    typist.process.send_signal(signal.SIGINT)
    assert typist.process.wait(timeout=10) == 0
    assert termios.tcgetattr(typist.side)[3] & termios.ICANON


def test_a_kill_leaves_the_terminal_as_before(graph: Graph, typist: Typist):
    graph.until(lambda: "stands |" in typist.look(), "the line")
    typist.process.terminate()
    assert typist.process.wait(timeout=10) == 0
    deadline = time.monotonic() + 5.0
    while not termios.tcgetattr(typist.side)[3] & termios.ICANON:
        assert time.monotonic() < deadline


def test_without_a_terminal_it_says_what_to_do(graph: Graph):
    done = subprocess.run(
        [str(TELEOP)],
        env=graph.environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=30,
    )
    assert done.returncode == 2
    assert "standard input is no terminal" in done.stderr
    assert "Traceback" not in done.stderr
