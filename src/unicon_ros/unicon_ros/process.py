"""A node's process from start to end: signals, errors in one line, exit status.

The signal handlers are our own: rclpy's take the context down first, after which a node could no longer
send its last message or close its files in peace.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import Protocol

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from unicon.errors import UniconError

PATIENCE_S = 0.1
"""Longest wait for a message, so that a signal is answered soon."""


class StopFlag:
    """Set by SIGINT or SIGTERM."""

    def __init__(self) -> None:
        self._set = False
        signal.signal(signal.SIGINT, self._handle)
        signal.signal(signal.SIGTERM, self._handle)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        self._set = True

    def set(self) -> None:
        """End the process as a signal would."""
        self._set = True

    def __bool__(self) -> bool:
        return self._set


class RunnableNode(Protocol):
    """What `run_node` needs of a node."""

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Work until ``stop`` is set."""
        ...

    def close(self) -> None:
        """Close files and sockets; the context is still up."""
        ...


def spin(executor: Executor, stop: StopFlag) -> None:
    """Take messages until ``stop`` is set: the `run` of a node that only has callbacks."""
    while not stop:
        executor.spin_once(timeout_sec=PATIENCE_S)


def run_node(make_node: Callable[[], RunnableNode], name: str) -> int:
    """Run a node until it is told to stop; return the exit status of the process."""
    stop = StopFlag()
    node: RunnableNode | None = None
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    executor = SingleThreadedExecutor()
    try:
        node = make_node()
        assert isinstance(node, Node)
        executor.add_node(node)
        node.run(executor, stop)
        return 0
    except UniconError as error:
        print(f"{name}: {error}", file=sys.stderr, flush=True)
        return 2
    finally:
        _end(node, executor)


def _end(node: RunnableNode | None, executor: Executor) -> None:
    if node is not None:
        node.close()
        executor.shutdown()
        node.destroy_node()  # type: ignore[attr-defined]
    rclpy.try_shutdown()
