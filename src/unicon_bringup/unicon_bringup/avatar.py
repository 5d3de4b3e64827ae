"""`ros2 run unicon_bringup avatar`: the graph of one avatar in one terminal, where there is no ros2 launch.

honcho starts the nodes, prefixes their output and ends them together. Unlike its default, the graph goes
on when a scheduler or the recorder ends: another one may join at any time. It ends with the executor.
"""

from __future__ import annotations

import os
import shlex
import sys

import tyro
from honcho.manager import Manager

from unicon.errors import UniconError
from unicon_bringup.graph import (
    GraphConfig,
    NodeEntry,
    choose_nodes,
    command,
    default_list,
    read_list,
)

ENDED_BY_SIGNAL = (130, 143, -2, -15)


class AvatarManager(Manager):
    """A process manager that ends with the executor, not with the first process that ends."""

    def __init__(self, executors: list[str]) -> None:
        super().__init__()
        self._executors = executors

    def _any_stopped(self) -> bool:
        return any(self._processes[name].get("returncode") is not None for name in self._executors)


def build_manager(entries: list[NodeEntry], config: GraphConfig) -> AvatarManager:
    """Return a manager of the chosen nodes, none of them started yet.

    Raises:
        UniconError: when the scheduler is unknown or a node is not installed.
    """
    chosen = choose_nodes(entries, config)
    manager = AvatarManager([e.name for e in chosen if e.role == "executor"])
    environment = dict(os.environ, PYTHONUNBUFFERED="1")
    for entry in chosen:
        line = shlex.join(["exec", *command(entry, config)])
        manager.add_process(entry.name, line, env=environment)
    return manager


def main() -> int:
    """Run the graph until it is interrupted; return the exit status."""
    config = tyro.cli(GraphConfig, prog="ros2 run unicon_bringup avatar", description=__doc__)
    try:
        manager = build_manager(read_list(default_list()), config)
    except UniconError as error:
        print(f"avatar: {error}", file=sys.stderr)
        return 2
    manager.loop()
    status = manager.returncode or 0
    return 0 if status in ENDED_BY_SIGNAL else abs(status)
