"""Tests for tools/bin/ros2, against a small workspace made by hand."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("ament_index_python", reason="the stand-in reads the ament index")

STAND_IN = Path(__file__).resolve().parents[1] / "tools" / "bin" / "ros2"
DEFINITION = "float64 height # [m]\n"
GOAL = "string food\n---\nbool eaten\n---\nfloat64 share\n"


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """An ament prefix with the package `zoo`: the executable `feed`, message `Animal` and action `Feed`."""
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "zoo").touch()
    program = tmp_path / "lib" / "zoo" / "feed"
    program.parent.mkdir(parents=True)
    program.write_text('#!/bin/sh\necho "fed $*"\nexit 7\n')
    program.chmod(0o755)
    (tmp_path / "lib" / "zoo" / "notes.txt").write_text("no program")
    message = tmp_path / "share" / "zoo" / "msg" / "Animal.msg"
    message.parent.mkdir(parents=True)
    message.write_text(DEFINITION)
    action = tmp_path / "share" / "zoo" / "action" / "Feed.action"
    action.parent.mkdir()
    action.write_text(GOAL)
    return tmp_path


def ros2(prefix: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Call the stand-in with one prefix in its index."""
    environment = {"AMENT_PREFIX_PATH": str(prefix), "PATH": "/usr/bin:/bin"}
    command = [sys.executable, str(STAND_IN), *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def test_run_hands_over_the_arguments_and_the_exit_status(prefix):
    result = ros2(prefix, "run", "zoo", "feed", "--ros-args", "-p", "food:=hay")
    assert result.stdout == "fed --ros-args -p food:=hay\n"
    assert result.returncode == 7


def test_executables_are_listed_with_their_package(prefix):
    assert ros2(prefix, "pkg", "executables").stdout == "zoo feed\n"
    assert ros2(prefix, "pkg", "executables", "zoo").stdout == "zoo feed\n"


def test_packages_are_listed(prefix):
    assert ros2(prefix, "pkg", "list").stdout == "zoo\n"


def test_an_interface_is_shown_as_it_was_written(prefix):
    assert ros2(prefix, "interface", "show", "zoo/msg/Animal").stdout == DEFINITION
    assert ros2(prefix, "interface", "show", "zoo/action/Feed").stdout == GOAL


@pytest.mark.parametrize(
    ("words", "nearest"),
    [
        (("run", "zooo", "feed"), "zoo"),
        (("run", "zoo", "fed"), "feed"),
        (("pkg", "executables", "zo"), "zoo"),
        (("interface", "show", "zoo/msg/Animals"), "Animal"),
        (("interface", "show", "zoa/msg/Animal"), "zoo"),
    ],
)
def test_an_unknown_name_ends_with_one_sentence_and_the_nearest(prefix, words, nearest):
    result = ros2(prefix, *words)
    assert result.returncode == 2
    assert result.stderr.count("\n") == 1
    assert nearest in result.stderr.split(";")[1]


def test_a_malformed_interface_name_is_explained(prefix):
    result = ros2(prefix, "interface", "show", "Animal")
    assert result.returncode == 2 and "PACKAGE/msg/TYPE" in result.stderr


def test_what_the_stand_in_lacks_is_answered_with_what_it_is_and_has(prefix):
    result = ros2(prefix, "topic", "list")
    assert result.returncode == 2
    assert "stand-in" in result.stderr and "ros2 run" in result.stderr
    assert result.stdout == ""


def test_help_is_no_mistake(prefix):
    result = ros2(prefix, "--help")
    assert result.returncode == 0 and "ros2 run PACKAGE EXECUTABLE" in result.stdout
