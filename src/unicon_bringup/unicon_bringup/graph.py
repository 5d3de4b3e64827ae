"""The one list of nodes (config/graph.yaml) and what follows from it: which nodes, with which arguments."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml
from ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
)

from unicon.errors import InputFileError, UniconError, UnknownNameError

ROLES = ("executor", "scheduler", "recorder")
NO_SCHEDULER = "none"


@dataclass(frozen=True)
class NodeEntry:
    """One node of the list."""

    name: str
    """Its name in the list, and the prefix of its output."""
    package: str
    executable: str
    role: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    """ROS parameters that differ from the node's defaults."""


@dataclass(frozen=True)
class GraphConfig:
    """Which nodes come up, and for which avatar."""

    avatar: str = "avatar"
    """Namespace of everything that belongs to this avatar, e.g. alice for /alice/state."""
    scheduler: str = "stitching"
    """Scheduler to start: a name in the list of nodes, or "none" to publish target frames yourself."""
    record: bool = False
    """Record all topics of the avatar."""
    output: str = ""
    """Folder of the recording; empty for one named by the avatar and the time."""
    slow_motion: bool = False
    """Let time slow down on a machine that cannot keep up, instead of letting the avatar fall."""


def default_list() -> Path:
    """Return the installed list of nodes."""
    return Path(get_package_share_directory("unicon_bringup")) / "config" / "graph.yaml"


def read_list(path: Path) -> list[NodeEntry]:
    """Read the list of nodes.

    Raises:
        InputFileError: when the file or one of its entries is not as described at its top.
    """
    try:
        content = yaml.safe_load(path.read_text())
    except (OSError, yaml.YAMLError) as error:
        raise InputFileError(f"{path}: cannot read the list of nodes: {error}") from error
    if not isinstance(content, dict):
        raise InputFileError(f"{path}: expected one entry a node, got {type(content).__name__}")
    return [_read_entry(path, name, entry) for name, entry in content.items()]


def _read_entry(path: Path, name: str, entry: Any) -> NodeEntry:
    expected = {"package", "executable", "role", "parameters"}
    if not isinstance(entry, dict) or set(entry) != expected:
        raise InputFileError(f"{path}: node {name!r} needs exactly the keys {sorted(expected)}")
    if entry["role"] not in ROLES:
        raise InputFileError(f"{path}: node {name!r} has the role {entry['role']!r}, not one of {ROLES}")
    return NodeEntry(name=name, **entry)


def choose_nodes(entries: list[NodeEntry], config: GraphConfig) -> list[NodeEntry]:
    """Return the nodes to start.

    Raises:
        UnknownNameError: when there is no such scheduler; the message lists those there are.
    """
    schedulers = [e.name for e in entries if e.role == "scheduler"]
    if config.scheduler not in (*schedulers, NO_SCHEDULER):
        near = difflib.get_close_matches(config.scheduler, schedulers, n=1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        known = ", ".join((*schedulers, NO_SCHEDULER))
        raise UnknownNameError(f"there is no scheduler {config.scheduler!r}{hint}; choose one of: {known}")
    return [e for e in entries if _is_chosen(e, config)]


def _is_chosen(entry: NodeEntry, config: GraphConfig) -> bool:
    if entry.role == "scheduler":
        return entry.name == config.scheduler
    return entry.role == "executor" or config.record


def parameters_of(entry: NodeEntry, config: GraphConfig) -> dict[str, Any]:
    """Return the ROS parameters of a node: the list's, then what the configuration asks for."""
    parameters = dict(entry.parameters)
    if entry.role == "executor" and config.slow_motion:
        parameters["slow_motion"] = True
    if entry.role == "recorder" and config.output:
        parameters["output"] = config.output
    return parameters


def ros_arguments(entry: NodeEntry, config: GraphConfig) -> list[str]:
    """Return the arguments that follow the executable: namespace and parameters."""
    arguments = ["--ros-args", "-r", f"__ns:=/{config.avatar}"]
    for name, value in parameters_of(entry, config).items():
        arguments += [
            "-p",
            f"{name}:={yaml.safe_dump(value, default_flow_style=True).splitlines()[0]}",
        ]
    return arguments


def command(entry: NodeEntry, config: GraphConfig) -> list[str]:
    """Return the whole command line of a node.

    Raises:
        UniconError: when its package or executable is not installed.
    """
    try:
        prefix = Path(get_package_prefix(entry.package))
    except PackageNotFoundError as error:
        raise UniconError(
            f"the ROS package {entry.package} is not built: run `make setup`, then `source setup.bash`"
        ) from error
    executable = prefix / "lib" / entry.package / entry.executable
    if not executable.exists():
        raise UniconError(f"{executable} does not exist: run `make setup` to build the workspace again")
    return [str(executable), *ros_arguments(entry, config)]
