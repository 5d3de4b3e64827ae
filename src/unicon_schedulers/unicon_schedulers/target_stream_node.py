"""What all schedulers share: target frames at 60 Hz, status and diagnostics."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rclpy.executors import Executor
from rclpy.node import Node

from unicon.motion.clip_index import RATE_HZ
from unicon.pacing import Pacer
from unicon.schedulers.stitching import Window
from unicon_msgs.msg import SchedulerStatus, TargetFrames
from unicon_ros.conversion import to_stamp, to_target_frames
from unicon_ros.diagnostics import OK, WARN, Diagnostics
from unicon_ros.parameters import Parameter, declare_parameters
from unicon_ros.process import StopFlag
from unicon_ros.qos import LATCHED, STREAM

STATUS_PERIOD_S = 1.0


class Playing(NamedTuple):
    """What a scheduler plays now."""

    name: str
    """Empty while it stands."""
    position_s: float = 0.0
    """Time within that."""
    queue: tuple[str, ...] = ()
    """What follows."""
    empty: bool = False
    """Whether nothing plays or waits."""


class TargetStreamNode(Node, ABC):
    """A node that sends windows of target frames.

    Its table of parameters has ``source``.

    Raises:
        UniconError: when a parameter cannot be used.
    """

    def __init__(self, name: str, parameters: Sequence[Parameter]) -> None:
        super().__init__(name)
        self.values = declare_parameters(self, parameters)
        self.pacer = Pacer(start_time_ns=time.time_ns())
        self.sent = 0
        """Target messages so far."""
        self._source: str = self.values["source"]
        self._shown: tuple[object, ...] = ()
        self._frames = self.create_publisher(TargetFrames, "target_frames", STREAM)
        self._status = self.create_publisher(SchedulerStatus, "~/status", LATCHED)
        self._diagnostics = Diagnostics(self)
        self.create_timer(STATUS_PERIOD_S, self.publish_status)

    @abstractmethod
    def next_frames(self, time_ns: int) -> Window:
        """Return the window of frames that begins one frame after ``time_ns``."""

    @abstractmethod
    def playing(self) -> Playing:
        """Return what plays."""

    def facts(self) -> Mapping[str, object]:
        """Return more values for the diagnostics."""
        return {}

    def changed(self, playing: Playing) -> None:
        """Do what is to be done when something else plays."""

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send a window sixty times a second until told to stop."""
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
        playing = self.playing()
        status = SchedulerStatus(
            source=self._source,
            playing=playing.name,
            position=playing.position_s,
            queue=list(playing.queue),
            empty=playing.empty,
            sent=self.sent,
        )
        status.header.stamp = to_stamp(time.time_ns())
        status.header.frame_id = "world"
        self._status.publish(status)
        statistics = self.pacer.statistics()
        slow = statistics.ticks > 0 and statistics.real_time_factor < 0.95
        self._diagnostics.publish(
            WARN if slow else OK,
            "does not keep up with real time" if slow else playing.name or "stands",
            {"sent": self.sent, "missed ticks": statistics.missed, **self.facts()},
        )

    def _send(self, time_ns: int) -> None:
        window = self.next_frames(time_ns)
        message = to_target_frames(self._source, self.sent, window.time_ns, 1.0 / RATE_HZ, window.frames)
        self._frames.publish(message)
        self.sent += 1
        playing = self.playing()
        shown = (playing.name, *playing.queue)
        if shown != self._shown:
            if self._shown:
                self.changed(playing)
            self._shown = shown
            self.publish_status()
