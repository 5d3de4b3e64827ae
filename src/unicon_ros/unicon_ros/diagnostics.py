"""What each node says of itself on /diagnostics, once a second (REP 107)."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from unicon_ros.qos import COMMAND

PERIOD_S = 1.0
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


class Diagnostics:
    """Publishes one status, named by the node's full name."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", COMMAND)

    def publish(self, level: bytes, message: str, values: Mapping[str, object]) -> None:
        """Say how the node is doing."""
        status = DiagnosticStatus(
            level=level,
            name=self._node.get_fully_qualified_name(),
            hardware_id="unicon",
            message=message,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)
