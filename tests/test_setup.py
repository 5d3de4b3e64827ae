"""Tests for tools/setup.py and setup.bash: the sentences that a person reads, and the stamps."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from tests.loading import load_script

ROOT = Path(__file__).resolve().parents[1]
SCRIPT = ROOT / "tools" / "setup.py"


@pytest.fixture
def setup(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The set-up script, working in an empty folder, with nothing of ROS in the environment."""
    module = load_script(SCRIPT)
    monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(module, "VENV", tmp_path / ".venv")
    monkeypatch.setattr(module, "STAMPS", tmp_path / ".venv" / ".unicon-stamps")
    monkeypatch.setattr(module, "LOG", tmp_path / "setup.log")
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    (tmp_path / ".venv" / "bin" / "python").symlink_to(sys.executable)
    for name in ("AMENT_PREFIX_PATH", "ROS_DISTRO"):
        monkeypatch.delenv(name, raising=False)
    return module


def refusal(setup: ModuleType) -> str:
    """Return the sentence with which the machine is refused."""
    with pytest.raises(setup.SetupError) as caught:
        setup.check_machine()
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_an_old_python_can_read_the_script_to_say_that_it_is_too_old():
    ast.parse(SCRIPT.read_text(), feature_version=(3, 8))


def test_a_wrong_python_is_named_with_what_to_type(setup, monkeypatch):
    monkeypatch.setattr(setup.sys, "version_info", (3, 10, 2))
    sentence = refusal(setup)
    assert "3.10" in sentence and "3.11" in sentence and "make PYTHON=" in sentence


def test_a_missing_compiler_is_named_with_what_to_type(setup, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    sentence = refusal(setup)
    assert "C++ compiler" in sentence and "sudo apt install g++" in sentence


def test_missing_headers_are_named_with_what_to_type(setup, monkeypatch, tmp_path):
    monkeypatch.setattr(setup.shutil, "which", lambda name: "/usr/bin/" + name)
    monkeypatch.setattr(setup.sysconfig, "get_paths", lambda: {"include": str(tmp_path)})
    assert "python3-dev" in refusal(setup)


def test_a_full_disk_is_named_with_what_is_needed(setup, monkeypatch):
    monkeypatch.setattr(setup.shutil, "which", lambda name: "/usr/bin/" + name)
    monkeypatch.setattr(setup.Path, "exists", lambda path: path.name == "Python.h")
    monkeypatch.setattr(setup.shutil, "disk_usage", lambda path: SimpleNamespace(free=10**9))
    sentence = refusal(setup)
    assert "1.0 GB" in sentence and "3 GB" in sentence


def test_an_unreachable_package_index_is_named(setup):
    nowhere = ["--isolated", "--retries", "1", "--index-url", "http://127.0.0.1:9/simple"]
    with pytest.raises(setup.SetupError, match="the package index cannot be reached"):
        setup.pip(["install", "--target", str(setup.ROOT / "out"), *nowhere, "six"], "installing")


def test_lack_of_space_during_a_step_is_named(setup):
    sentence = setup.explain("installing", "OSError: [Errno 28] No space left on device", True)
    assert "disk space" in sentence and "\n" not in sentence


def test_any_other_failure_shows_its_last_line_and_its_log(setup):
    sentence = setup.explain("building", "first\nlast words\n", True)
    assert "last words" in sentence and str(setup.LOG) in sentence


def test_an_unknown_group_ends_with_one_sentence_and_status_2(setup, capsys):
    assert setup.main(["bse"]) == 2
    printed = capsys.readouterr().err
    assert "bse" in printed and "base" in printed and printed.count("\n") == 1


def test_groups_keep_their_order_and_default_to_those_of_the_demo(setup):
    assert setup.choose_groups([]) == ["base", "ros"]
    assert setup.choose_groups(["dev", "base"]) == ["base", "dev"]


def test_another_distribution_of_ros_is_refused(setup, monkeypatch, tmp_path_factory):
    humble = tmp_path_factory.mktemp("humble")
    index = humble / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "rclpy").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(humble))
    monkeypatch.setenv("ROS_DISTRO", "humble")
    with pytest.raises(setup.SetupError, match="humble is sourced, but Jazzy is needed"):
        setup.has_sourced_ros()


def test_the_projects_own_prefixes_are_not_taken_for_a_sourced_ros(setup, monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{setup.ROOT}/ros_ws/install/a:{setup.VENV}")
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    assert not setup.has_sourced_ros()


def test_with_a_sourced_jazzy_the_wheels_are_left_out(setup, monkeypatch):
    monkeypatch.setattr(setup, "ROOT", ROOT)
    with_wheels = [label for label, *_ in setup.plan(["base", "ros"], with_ros=False)]
    without = [label for label, *_ in setup.plan(["base", "ros"], with_ros=True)]
    assert set(with_wheels) - set(without) == {"installing ros packages"}


def test_a_step_that_is_done_is_done_once(setup):
    calls: list[int] = []
    for _ in range(2):
        setup.run_step("step", "name", ["input"], lambda: calls.append(1))
    assert calls == [1]


def test_a_step_is_done_again_when_what_it_depends_on_changes(setup):
    calls: list[str] = []
    for word in ("old", "new", "new"):
        setup.run_step("step", "name", [word], lambda word=word: calls.append(word))
    assert calls == ["old", "new"]


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, RuntimeError])
def test_an_interrupted_step_is_done_again(setup, interruption):
    def stop() -> None:
        raise interruption

    with pytest.raises(interruption):
        setup.run_step("step", "name", ["input"], stop)
    calls: list[int] = []
    setup.run_step("step", "name", ["input"], lambda: calls.append(1))
    assert calls == [1]


def test_the_build_depends_on_what_messages_say(setup, tmp_path):
    message = tmp_path / "package" / "msg" / "A.msg"
    message.parent.mkdir(parents=True)
    message.write_text("int8 a")
    before = setup.hash_tree(tmp_path, setup.BUILD_INPUTS)
    message.write_text("int8 b")
    assert setup.hash_tree(tmp_path, setup.BUILD_INPUTS) != before


def test_where_opengl_is_missing_and_nothing_may_be_installed_one_line_says_what_to_type(setup, monkeypatch):
    monkeypatch.setattr(setup, "loads", lambda library: False)
    monkeypatch.setattr(setup.shutil, "which", lambda name: None)
    assert "sudo apt install libegl1" in setup.provide_gl()


def fake_checkout(folder: Path) -> Path:
    """Return a folder with setup.bash and an empty .venv."""
    activate = folder / ".venv" / "bin" / "activate"
    activate.parent.mkdir(parents=True)
    activate.write_text(f'export VIRTUAL_ENV="{folder}/.venv"\n')
    shutil.copy(ROOT / "setup.bash", folder)
    (folder / "tools" / "bin").mkdir(parents=True)
    executable(folder / "tools" / "bin" / "ros2")
    return folder / "setup.bash"


def executable(path: Path) -> Path:
    """Write an empty program."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


def bash(command: str, **variables: str) -> str:
    """Return what a bash with a bare environment prints."""
    environment = {"PATH": "/usr/bin:/bin", "HOME": os.environ.get("HOME", "/"), **variables}
    result = subprocess.run(["bash", "-c", command], env=environment, capture_output=True, text=True)
    return result.stdout + result.stderr


def test_setup_bash_offers_the_stand_in_where_there_is_no_ros2(tmp_path):
    script = fake_checkout(tmp_path)
    found = bash(f"source {script}; command -v ros2").strip()
    assert found in (str(tmp_path / "tools" / "bin" / "ros2"), "/usr/bin/ros2", "/bin/ros2")


def test_setup_bash_never_shadows_a_real_ros2(tmp_path):
    script = fake_checkout(tmp_path / "checkout")
    real = executable(tmp_path / "jazzy" / "bin" / "ros2")
    path = f"{real.parent}:/usr/bin:/bin"
    assert bash(f"source {script}; command -v ros2", PATH=path).strip() == str(real)


def test_setup_bash_leaves_a_sourced_ros_and_set_variables_alone(tmp_path):
    script = fake_checkout(tmp_path)
    command = f'source {script}; echo "$AMENT_PREFIX_PATH $ROS_AUTOMATIC_DISCOVERY_RANGE"'
    variables = {"AMENT_PREFIX_PATH": "/opt/j", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert bash(command, **variables).strip() == "/opt/j SUBNET"


def test_setup_bash_works_under_nounset_from_another_folder_and_leaves_it_set(tmp_path):
    script = fake_checkout(tmp_path)
    printed = bash(f"set -u; cd /; source {script}; echo $VIRTUAL_ENV $-")
    assert printed.startswith(f"{tmp_path}/.venv ")
    assert "u" in printed.split()[1]


def test_setup_bash_says_that_setup_has_not_run(tmp_path):
    shutil.copy(ROOT / "setup.bash", tmp_path)
    assert "make setup" in bash(f"source {tmp_path}/setup.bash")


def test_set_up_inside_an_activated_environment_uses_the_python_behind_it(setup):
    assert Path(setup.PYTHON).is_file()
    assert not Path(setup.PYTHON).is_relative_to(ROOT / ".venv")


def test_a_wrong_python_hands_over_to_one_that_will_do(setup, monkeypatch, tmp_path):
    (tmp_path / "python3.12").symlink_to(sys.executable)
    monkeypatch.setenv("PATH", str(tmp_path))
    started: list[list[str]] = []
    monkeypatch.setattr(setup.os, "execv", lambda path, words: started.append(words))
    setup.change_python(["base"])
    assert started[0][0].endswith("python3.12") and started[0][-1] == "base"


def test_the_wheels_of_another_checkout_are_not_taken_for_a_sourced_ros(setup, monkeypatch, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    index = other / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "rclpy").touch()
    (other / "pyvenv.cfg").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(other))
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    assert not setup.has_sourced_ros()


def test_a_group_that_was_interrupted_is_installed_afresh(setup, monkeypatch):
    calls: list[list[str]] = []

    def interrupt(arguments: list[str], what: str) -> None:
        calls.append(arguments)
        if len(calls) == 1:
            raise KeyboardInterrupt

    setup.STAMPS.mkdir(parents=True)
    monkeypatch.setattr(setup, "pip", interrupt)
    group = setup.ROOT / "requirements" / "base.txt"
    with pytest.raises(KeyboardInterrupt):
        setup.install_requirements(group, group)
    for _ in range(2):
        setup.install_requirements(group, group)
    assert ["--force-reinstall" in arguments for arguments in calls] == [False, True, False]


def test_a_program_that_cannot_be_started_is_named(setup):
    with pytest.raises(setup.SetupError, match="cannot run /no/such/program"):
        setup.run(["/no/such/program"], "trying")
