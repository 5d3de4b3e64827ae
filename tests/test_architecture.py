"""The shape of the project: imports, one list of nodes in three views, parameters and messages documented."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
GRAPH = yaml.safe_load((ROOT / "src/unicon_bringup/config/graph.yaml").read_text())
MESSAGES = sorted(
    path for kind in ("msg", "srv", "action") for path in (ROOT / "src/unicon_msgs" / kind).glob(f"*.{kind}")
)


def test_the_import_contracts_hold():
    command = [str(Path(sys.executable).parent / "lint-imports")]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout


def test_the_library_loads_neither_ros_nor_torch():
    code = "import sys, unicon.cli, unicon.recording.replay; "
    code += "print([m for m in ('rclpy', 'torch') if m in sys.modules])"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def test_compose_has_a_service_for_every_node_of_the_list_and_no_other():
    services = yaml.safe_load((ROOT / "compose.yaml").read_text())["services"]
    nodes = {name: service for name, service in services.items() if "healthcheck" in service}
    assert set(nodes) == set(GRAPH)
    for name, entry in GRAPH.items():
        assert nodes[name]["command"][:4] == ["ros2", "run", entry["package"], entry["executable"]]
        assert f"/{name}" in nodes[name]["healthcheck"]["test"][-1]
        given = [word for word in nodes[name]["command"][4:] if ":=" in word and not word.startswith("__ns")]
        assert given == [
            f"{key}:={yaml.safe_dump(value).split()[0]}" for key, value in entry["parameters"].items()
        ]
        assert services[name]["ipc"] == "host"


def test_launch_file_and_process_manager_start_the_same_nodes():
    graph = pytest.importorskip("unicon_bringup.graph", reason="no ROS workspace: source setup.bash")
    avatar = pytest.importorskip("unicon_bringup.avatar")
    entries = graph.read_list(ROOT / "src/unicon_bringup/config/graph.yaml")
    assert {e.name: (e.package, e.executable) for e in entries} == {
        name: (entry["package"], entry["executable"]) for name, entry in GRAPH.items()
    }
    config = graph.GraphConfig(avatar="alice", record=True, output="bag", slow_motion=True)
    manager = avatar.build_manager(entries, config)
    others = {name for name, entry in GRAPH.items() if entry["role"] == "scheduler"} - {"stitching"}
    assert set(manager._processes) == set(GRAPH) - others
    command = manager._processes["recorder"]["obj"].cmd
    assert "__ns:=/alice" in command
    assert "output:=bag" in command
    launch = (ROOT / "src/unicon_bringup/launch/avatar.launch.py").read_text()
    assert "choose_nodes(read_list(default_list()), config)" in launch


def test_every_executable_of_the_list_is_installed_by_its_package():
    for entry in GRAPH.values():
        setup = (ROOT / "src" / entry["package"] / "setup.py").read_text()
        assert f'"{entry["executable"]} = ' in setup


def test_an_unknown_scheduler_is_answered_with_those_there_are():
    graph = pytest.importorskip("unicon_bringup.graph", reason="no ROS workspace: source setup.bash")
    errors = pytest.importorskip("unicon.errors")
    entries = graph.read_list(ROOT / "src/unicon_bringup/config/graph.yaml")
    with pytest.raises(errors.UnknownNameError, match="did you mean stitching"):
        graph.choose_nodes(entries, graph.GraphConfig(scheduler="stiching"))
    alone = graph.choose_nodes(entries, graph.GraphConfig(scheduler="none"))
    assert [entry.name for entry in alone] == ["executor"]


TABLES = {
    "unicon_executor": ["unicon_executor.parameters"],
    "unicon_schedulers": [
        "unicon_schedulers.stitching_node",
        "unicon_schedulers.dataset_node",
        "unicon_schedulers.keyboard_node",
        "unicon_schedulers.teleop_keyboard",
    ],
    "unicon_recorder": ["unicon_recorder.recorder_node"],
}


@pytest.mark.parametrize(("package", "name"), [(p, name) for p, names in TABLES.items() for name in names])
def test_every_parameter_has_a_description_and_a_range_and_stands_in_the_readme(package, name):
    module = pytest.importorskip(name, reason="no ROS workspace: source setup.bash")
    parameters = pytest.importorskip("unicon_ros.parameters")
    for parameter in module.PARAMETERS:
        assert len(parameter.description) > 10
        if isinstance(parameter.default, int | float) and not isinstance(parameter.default, bool):
            assert parameter.minimum <= parameter.default <= parameter.maximum
        descriptor = parameter.descriptor()
        assert descriptor.description
        assert descriptor.additional_constraints
    readme = (ROOT / "src" / package / "README.md").read_text()
    assert parameters.markdown_table(module.PARAMETERS) in readme


@pytest.mark.parametrize("path", MESSAGES, ids=lambda path: path.stem)
def test_every_line_of_a_message_has_a_comment(path):
    for line in path.read_text().splitlines():
        text = line.strip()
        if text and text != "---":
            assert re.search(r"#\s*\S", text), f"{path.name}: {text}"


def test_every_message_is_built():
    cmake = (ROOT / "src/unicon_msgs/CMakeLists.txt").read_text()
    assert len(MESSAGES) > 10
    for path in MESSAGES:
        assert f'"{path.parent.name}/{path.name}"' in cmake


def test_the_repository_names_no_machine():
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    names = [name for name in tracked.stdout.split() if (ROOT / name).is_file()]
    for name in names:
        path = ROOT / name
        if path.suffix in (".py", ".md", ".txt", ".yaml", ".toml", ".bash", ""):
            text = path.read_text(errors="ignore")
            assert not re.search(r"(^|[\s\"'(])/(work|farm)/", text), name
