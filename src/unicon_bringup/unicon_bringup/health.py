"""`ros2 run unicon_bringup health /avatar/executor`: exit status 0 when a node says that it is well.

Nodes say so on /diagnostics, once a second.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from typing import Annotated

import rclpy
import tyro
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from unicon_ros.qos import COMMAND


@dataclass(frozen=True)
class HealthConfig:
    """Which node to listen for."""

    node: Annotated[str, tyro.conf.Positional]
    """Full name of the node, e.g. /avatar/executor."""
    timeout_s: float = 5.0
    """How long to wait for it [s]."""


def main() -> int:
    """Listen; return 0 when the node is heard and has no error, 1 otherwise."""
    config = tyro.cli(HealthConfig, prog="ros2 run unicon_bringup health", description=__doc__)
    rclpy.init()
    node = Node("health")
    heard: list[DiagnosticStatus] = []

    def take(message: DiagnosticArray) -> None:
        heard.extend(status for status in message.status if status.name == config.node)

    node.create_subscription(DiagnosticArray, "/diagnostics", take, COMMAND)
    deadline = time.monotonic() + config.timeout_s
    while not heard and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.try_shutdown()
    if not heard:
        print(f"{config.node} was not heard for {config.timeout_s:g} s", file=sys.stderr)
        return 1
    print(heard[-1].message)
    return 1 if heard[-1].level == DiagnosticStatus.ERROR else 0
