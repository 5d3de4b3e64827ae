"""Tests for what the terminal program leaves behind, however it ends."""

from __future__ import annotations

import os
import signal
import termios
from collections.abc import Iterator

import pytest
from geometry_msgs.msg import Point
from rclpy.action import ActionClient

from tests.ros.conftest import Graph
from tests.ros.test_keyboard import Typist
from unicon_msgs.action import GoTo
from unicon_msgs.msg import LocomotionCommand
from unicon_ros.qos import COMMAND

pytestmark = pytest.mark.ros


@pytest.fixture
def person(graph: Graph) -> Iterator[Typist]:
    made = Typist(graph)
    graph.until(lambda: "stands |" in made.look(), "the line")
    yield made
    made.process.kill()
    made.process.wait()
    if made.side >= 0:
        os.close(made.side)


def edits_lines(person: Typist) -> bool:
    return bool(termios.tcgetattr(person.side)[3] & termios.ICANON)


def walk(graph: Graph, person: Typist) -> list[LocomotionCommand]:
    """Hold a key until commands come; return them, and those that follow."""
    commands = graph.listen(LocomotionCommand, "locomotion_command", COMMAND)

    def walks() -> bool:
        person.type("w")
        person.look()
        return bool(commands) and commands[-1].forward > 0.0

    graph.until(walks, "a command to walk")
    return commands


def test_quitting_while_it_walks_stops_it(graph: Graph, person: Typist):
    commands = walk(graph, person)
    person.process.send_signal(signal.SIGINT)
    assert person.process.wait(timeout=10) == 0
    graph.until(lambda: commands[-1].forward == 0.0, "the command to stop")
    assert edits_lines(person)


def test_a_terminal_that_goes_away_ends_it_and_stops_the_character(graph: Graph, person: Typist):
    commands = walk(graph, person)
    os.close(person.side)
    person.side = -1
    graph.until(lambda: person.process.poll() is not None, "the end")
    assert person.process.returncode == 0
    graph.until(lambda: commands[-1].forward == 0.0, "the command to stop")


def test_it_gives_the_terminal_back_while_it_is_suspended_and_takes_it_again(graph: Graph, person: Typist):
    person.process.send_signal(signal.SIGTSTP)
    graph.until(lambda: edits_lines(person), "the terminal as before")
    person.process.send_signal(signal.SIGCONT)
    graph.until(lambda: not edits_lines(person), "a terminal that gives every key")
    walk(graph, person)


def test_an_arrow_with_a_modifier_is_that_arrow_and_leaves_the_gait(graph: Graph, person: Typist):
    commands = graph.listen(LocomotionCommand, "locomotion_command", COMMAND)

    def turns() -> bool:
        person.type("\x1b[1;2D")
        person.look()
        return bool(commands) and commands[-1].turn_rate > 0.0

    graph.until(turns, "a turn to the left")
    assert "jog" not in person.look().split("stands |", 1)[1]


def test_a_key_that_stops_ends_a_go_to(graph: Graph, person: Typist):
    graph.start("unicon_schedulers", "keyboard_node")
    client = ActionClient(graph.node, GoTo, "keyboard/go_to")
    graph.until(client.server_is_ready, "the action")
    graph.until(lambda: "no executor" in person.look()[-200:], "a line that somebody listens")
    future = client.send_goal_async(GoTo.Goal(position=Point(x=9.0)))
    graph.until(future.done, "an answer to the goal")
    result = future.result().get_result_async()
    person.type(" ")
    graph.until(result.done, "the end of the go-to")
    assert result.result().result.message == "another command came"
