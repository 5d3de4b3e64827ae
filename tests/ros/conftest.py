"""Real processes on a ROS domain of their own: started, talked to, waited for on conditions, ended."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="no ROS in this environment: source setup.bash")

import domain_coordinator
import rclpy
from ament_index_python.packages import get_package_prefix
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from tests.samples import swaying_clip
from unicon.motion.store.library_writer import LibraryWriter

PATIENCE_S = 20.0


class Graph:
    """One domain with processes and a node of ours in it."""

    def __init__(self, domain: int, folder: Path) -> None:
        self.folder = folder
        self.domain = domain
        self.environment = dict(
            os.environ,
            ROS_DOMAIN_ID=str(domain),
            ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST",
            FASTDDS_BUILTIN_TRANSPORTS="UDPv4",
            ROS_PYTHON_CHECK_FIELDS="1",
            ROS_LOG_DIR=str(folder / "log"),
            UNICON_CACHE=str(folder / "cache"),
        )
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = Node("tester", namespace="a", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.processes: list[subprocess.Popen] = []

    def start(self, package: str, executable: str, *arguments: str, **parameters: object) -> subprocess.Popen:
        """Start a node in the namespace /a; its output goes to a file."""
        command = [str(Path(get_package_prefix(package)) / "lib" / package / executable), *arguments]
        command += ["--ros-args", "-r", "__ns:=/a"]
        for name, value in parameters.items():
            command += ["-p", f"{name}:={value}"]
        output = (self.folder / f"{executable}_{len(self.processes)}.log").open("w")
        process = subprocess.Popen(
            command, env=self.environment, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        )
        process.output = Path(output.name)
        self.processes.append(process)
        return process

    def until(self, done: Callable[[], object], what: str, patience_s: float = PATIENCE_S) -> None:
        """Take messages until a condition holds."""
        deadline = time.monotonic() + patience_s
        while not done():
            if time.monotonic() > deadline:
                logs = "\n".join(p.output.read_text()[-2000:] for p in self.processes)
                pytest.fail(f"waited {patience_s:.0f} s in vain for {what}\n{logs}")
            self.executor.spin_once(timeout_sec=0.02)

    def listen(self, kind: type, topic: str, quality: object) -> list:
        """Return a list that fills with a topic's messages."""
        heard: list = []
        self.node.create_subscription(kind, topic, heard.append, quality)
        return heard

    def call(self, kind: type, name: str, request: object = None) -> object:
        """Call a service and return its answer."""
        client = self.node.create_client(kind, name)
        self.until(client.service_is_ready, f"service {name}")
        future = client.call_async(request or kind.Request())
        self.until(future.done, f"answer of {name}")
        return future.result()

    def close(self) -> None:
        """End everything; a second call does nothing."""
        if not self.context.ok():
            return
        for process in self.processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.executor.remove_node(self.node)
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self.context)


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[Graph]:
    with domain_coordinator.domain_id() as domain:
        graph = Graph(int(domain), tmp_path)
        try:
            yield graph
        finally:
            graph.close()


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A library of two clips."""
    with LibraryWriter(tmp_path / "library") as writer:
        writer.add_clip(swaying_clip(120, name="sway"))
        writer.add_clip(swaying_clip(60, name="bow"))
        writer.commit()
    return writer.folder


def end(process: subprocess.Popen, number: int = signal.SIGINT) -> int:
    """Ask a process to end and return its exit status."""
    process.send_signal(number)
    return process.wait(timeout=10)
