"""One run of the graph, driven from Python: starts it, waits until it is ready, calls its services, ends it.

Used by the demo and the benchmark. The graph itself is the same process that `ros2 run unicon_bringup
avatar` starts; its output goes to a log file.
"""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import rclpy
from ament_index_python.packages import get_package_prefix
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from unicon.errors import UniconError
from unicon_bringup.graph import GraphConfig
from unicon_msgs.msg import ExecutorStatus
from unicon_msgs.srv import QueueMotion, Reset
from unicon_ros.qos import COMMAND, LATCHED

READY_TIMEOUT_S = 30.0
CALL_TIMEOUT_S = 5.0
END_TIMEOUT_S = 10.0


class GraphSession:
    """The running graph and a node that talks to it."""

    def __init__(self, config: GraphConfig, log_file: Path) -> None:
        self.config = config
        self.log_file = log_file
        self.status: ExecutorStatus | None = None
        """The executor's newest status."""

    def __enter__(self) -> Self:
        self.log_file.parent.mkdir(parents=True, exist_ok=True)
        with self.log_file.open("w") as log:
            self._process = subprocess.Popen(
                self._command(), stdout=log, stderr=subprocess.STDOUT, start_new_session=True
            )
        rclpy.init()
        self.node = Node("session", namespace=self.config.avatar)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self.node.create_subscription(ExecutorStatus, "status", self._keep_status, LATCHED)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.end()
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()

    def _command(self) -> list[str]:
        executable = Path(get_package_prefix("unicon_bringup")) / "lib/unicon_bringup/avatar"
        config = self.config
        flags = ["--avatar", config.avatar, "--scheduler", config.scheduler]
        flags += ["--record" if config.record else "--no-record"]
        flags += ["--slow-motion" if config.slow_motion else "--no-slow-motion"]
        if config.output:
            flags += ["--output", config.output]
        return [str(executable), *flags]

    def _keep_status(self, message: ExecutorStatus) -> None:
        self.status = message

    def spin_until(self, done: Callable[[], bool], timeout_s: float, what: str) -> None:
        """Take messages until ``done()``.

        Raises:
            UniconError: after ``timeout_s``, or when the graph ended; the message names ``what``.
        """
        deadline = time.monotonic() + timeout_s
        while not done():
            if self._process.poll() is not None:
                raise UniconError(f"the graph ended while waiting for {what}; see {self.log_file}")
            if time.monotonic() > deadline:
                raise UniconError(f"no {what} within {timeout_s:.0f} s; see {self.log_file}")
            self._executor.spin_once(timeout_sec=0.05)

    def spin_for(self, duration_s: float, tick: Callable[[float], None] | None = None) -> None:
        """Take messages for ``duration_s``, calling ``tick(elapsed_s)`` now and then."""
        start = time.monotonic()

        def is_over() -> bool:
            elapsed = time.monotonic() - start
            if tick is not None:
                tick(elapsed)
            return elapsed >= duration_s

        self.spin_until(is_over, duration_s + 1.0, "end of the run")

    def wait_until_ready(self) -> None:
        """Wait for the executor's first status."""
        self.spin_until(lambda: self.status is not None, READY_TIMEOUT_S, "status of the executor")

    def wait_until_recorded(self, *streams: str) -> None:
        """Wait until the recorder says that it receives numbered streams, e.g. ``state``.

        That a subscription is listed does not mean that it is matched with the publisher yet.
        """
        recorder = f"/{self.config.avatar}/recorder"
        received: set[str] = set()

        def take(message: DiagnosticArray) -> None:
            received.update(v.key for s in message.status if s.name == recorder for v in s.values)

        subscription = self.node.create_subscription(DiagnosticArray, "/diagnostics", take, COMMAND)
        what = "recording of " + ", ".join(streams)
        self.spin_until(lambda: received.issuperset(streams), READY_TIMEOUT_S, what)
        self.node.destroy_subscription(subscription)

    def call(self, service_type: type, name: str, request: Any) -> Any:
        """Call a service of the graph and return its response.

        Raises:
            UniconError: when the service does not answer in time.
        """
        client = self.node.create_client(service_type, name)
        self.spin_until(client.service_is_ready, READY_TIMEOUT_S, f"service {name}")
        future = client.call_async(request)
        self.spin_until(future.done, CALL_TIMEOUT_S, f"answer of {name}")
        self.node.destroy_client(client)
        return future.result()

    def reset(self) -> None:
        """Put the avatar into its rest pose and forget all targets."""
        self.call(Reset, "executor/reset", Reset.Request(to=Reset.Request.REST))

    def queue(self, motion: str, transition_s: float) -> None:
        """Append a motion to the stitching node's queue.

        Raises:
            UniconError: when the node refuses it.
        """
        request = QueueMotion.Request(name=motion, transition=transition_s)
        response = self.call(QueueMotion, "stitching/queue_motion", request)
        if not response.success:
            raise UniconError(response.message)

    def end(self) -> None:
        """End the graph as Ctrl-C does, and wait for it."""
        if self._process.poll() is not None:
            return
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
