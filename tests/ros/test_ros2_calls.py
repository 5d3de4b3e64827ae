"""Tests for tools/ros2_calls.py, by the stand-in, against nodes that run."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from tests.ros.conftest import Graph

pytestmark = pytest.mark.ros

STAND_IN = Path(__file__).resolve().parents[2] / "tools" / "bin" / "ros2"
GO_TO = ["--feedback", "/a/keyboard/go_to", "unicon_msgs/action/GoTo"]


def ros2(graph: Graph, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(STAND_IN), *words]
    return subprocess.run(command, env=graph.environment, capture_output=True, text=True, timeout=60)


def test_a_service_is_called_and_its_answer_printed(graph: Graph):
    graph.start("unicon_executor", "executor_node", policy="reference_servo")
    done = ros2(graph, "service", "call", "/a/executor/reset", "unicon_msgs/srv/Reset", "{to: 0}")
    assert done.returncode == 0, done.stderr
    assert yaml.safe_load(done.stdout)["success"] is True


def test_a_goal_is_sent_followed_and_called_back_on_ctrl_c(graph: Graph):
    graph.start("unicon_schedulers", "keyboard_node")
    words = [str(STAND_IN), "action", "send_goal", *GO_TO, "{position: {x: 30}}"]
    with subprocess.Popen(
        [sys.executable, *words], env=graph.environment, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("distance: ")
        process.send_signal(signal.SIGINT)
        answer = process.stdout.read()
    assert process.returncode == 0
    assert "success: false" in answer and "message: cancelled" in answer


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("service", "call", "/x", "unicon_msgs/srv/Reset", "{tto: 0}"), "did you mean to?"),
        (("service", "call", "/x", "unicon_msgs/srv/Reset", "{to: high}"), "'to' is 'high', expected"),
        (("service", "call", "/x", "unicon_msgs/srv/Resett"), "there is no type"),
        (("service", "call", "/x", "Reset"), "expected PACKAGE/srv/TYPE"),
        (("service", "call", "/x", "unicon_msgs/srv/Reset", "{to: 0}"), "is its node running?"),
        (("action", "send_goal", "/x", "unicon_msgs/action/GoTo", "[1"), "is no YAML"),
        (("action", "send_goal", "/x"), "it needs a name and a type"),
    ],
)
def test_a_wrong_call_is_answered_with_one_sentence(graph: Graph, words, sentence):
    done = ros2(graph, *words)
    assert done.returncode == 2
    assert sentence in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr
