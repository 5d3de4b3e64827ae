"""What schedulers that play clips share: a stitcher's path as target frames at 60 Hz, status, diagnostics."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from rclpy.executors import Executor
from rclpy.node import Node
from rich.console import Console

from unicon.motion.clip import RATE_HZ
from unicon.motion.store.library_choice import open_library
from unicon.pacing import Pacer
from unicon.schedulers.stitching import Stitcher
from unicon_msgs.msg import SchedulerStatus, TargetFrames
from unicon_ros.conversion import to_stamp, to_target_frames
from unicon_ros.diagnostics import OK, WARN, Diagnostics
from unicon_ros.parameters import Parameter, declare_parameters
from unicon_ros.process import StopFlag
from unicon_ros.qos import LATCHED, STREAM

STATUS_PERIOD_S = 1.0

LIBRARY = Parameter(
    "library", "", "folder of a clip library; empty for that of $UNICON_LIBRARY, or else the shipped one"
)
WINDOW = Parameter("window", 8, "frames in each message", "frames", 1, 64)


class SchedulerNode(Node):
    """A node that sends the path of its stitcher.

    Its table of parameters has ``library`` and ``source``.

    Raises:
        UniconError: when a parameter or the library cannot be used.
    """

    stitcher: Stitcher
    """The path; set by the node that knows what to play, before it runs."""

    def __init__(self, name: str, parameters: Sequence[Parameter]) -> None:
        super().__init__(name)
        self.values = declare_parameters(self, parameters)
        library: str = self.values["library"]
        self.library = open_library(Path(library) if library else None, Console(stderr=True))
        self.pacer = Pacer(start_time_ns=time.time_ns())
        self._source: str = self.values["source"]
        self._sequence = 0
        self._shown: tuple[object, ...] = ()
        self._frames = self.create_publisher(TargetFrames, "target_frames", STREAM)
        self._status = self.create_publisher(SchedulerStatus, "~/status", LATCHED)
        self._diagnostics = Diagnostics(self)
        self.create_timer(STATUS_PERIOD_S, self.publish_status)

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send a window sixty times a second until told to stop."""
        self.get_logger().info(f"ready: {len(self.library.names)} motions in {self.library.folder}")
        self.pacer.resume()
        while not stop:
            remaining_s = self.pacer.remaining_s()
            if remaining_s > 0:
                executor.spin_once(timeout_sec=remaining_s)
                continue
            self.pacer.begin()
            self._send(self.pacer.tick_time_ns)
            self.pacer.finish()

    def close(self) -> None:
        """Nothing is open."""

    def publish_status(self) -> None:
        """Say what plays and how it goes."""
        stitcher = self.stitcher
        status = SchedulerStatus(
            source=self._source,
            playing=stitcher.playing.name,
            position=stitcher.position_s,
            queue=stitcher.queued,
            empty=stitcher.empty,
            sent=self._sequence,
        )
        status.header.stamp = to_stamp(time.time_ns())
        status.header.frame_id = "world"
        self._status.publish(status)
        statistics = self.pacer.statistics()
        slow = statistics.ticks > 0 and statistics.real_time_factor < 0.95
        self._diagnostics.publish(
            WARN if slow else OK,
            "does not keep up with real time" if slow else stitcher.playing.name or "stands",
            {
                "sent": self._sequence,
                "queued": len(stitcher.queued),
                "missed ticks": statistics.missed,
            },
        )

    def _send(self, time_ns: int) -> None:
        window = self.stitcher.next_frames(time_ns)
        message = to_target_frames(self._source, self._sequence, window.time_ns, 1.0 / RATE_HZ, window.frames)
        self._frames.publish(message)
        self._sequence += 1
        shown = (self.stitcher.playing.name, *self.stitcher.queued)
        if shown != self._shown:
            if self._shown and self.stitcher.empty:
                self.get_logger().info("nothing more to play: stands and waits for a motion")
            self._shown = shown
            self.publish_status()
