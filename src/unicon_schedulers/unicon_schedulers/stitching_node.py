"""`ros2 run unicon_schedulers stitching_node`: plays queued clips as one endless stream of target frames."""

from __future__ import annotations

import time
from pathlib import Path

from rclpy.executors import Executor
from rclpy.node import Node
from rich.console import Console
from std_srvs.srv import Trigger

from unicon.errors import UniconError
from unicon.motion.clip import RATE_HZ
from unicon.motion.fetch import fetch
from unicon.motion.library import ClipLibrary
from unicon.pacing import Pacer
from unicon.schedulers.stitching import Stitcher, StitcherConfig
from unicon_msgs.msg import MotionInfo, SchedulerStatus, TargetFrames
from unicon_msgs.srv import ListMotions, QueueMotion
from unicon_ros.conversion import to_stamp, to_target_frames
from unicon_ros.diagnostics import OK, WARN, Diagnostics
from unicon_ros.parameters import Parameter, declare_parameters
from unicon_ros.process import StopFlag, run_node
from unicon_ros.qos import LATCHED, STREAM

STATUS_PERIOD_S = 1.0

PARAMETERS = (
    Parameter("library", "", "folder of clips; empty for the free motions that are fetched into the cache"),
    Parameter("queue", [""], "motions to begin with"),
    Parameter("transition_s", 0.5, "length of a transition where none is given", "s", 0.0, 5.0),
    Parameter("window", 8, "frames in each message", "frames", 1, 64),
    Parameter("source", "stitching", "name under which the target frames are published"),
)


class StitchingNode(Node):
    """The stitching scheduler.

    Raises:
        UniconError: when there is no library, or a motion of the parameter queue is not in it.
    """

    def __init__(self) -> None:
        super().__init__("stitching")
        values = declare_parameters(self, PARAMETERS)
        self._source: str = values["source"]
        library: str = values["library"]
        self._library = ClipLibrary(Path(library)) if library else fetch(Console(stderr=True))
        config = StitcherConfig(window=values["window"], transition_s=values["transition_s"])
        self._pacer = Pacer(start_time_ns=time.time_ns())
        self._stitcher = Stitcher(config, self._pacer.tick_time_ns)
        for name in filter(None, values["queue"]):
            self._stitcher.queue(self._library.get(name), config.transition_s)
        self._sequence = 0
        self._shown: tuple[object, ...] = ()
        self._frames = self.create_publisher(TargetFrames, "target_frames", STREAM)
        self._status = self.create_publisher(SchedulerStatus, "~/status", LATCHED)
        self._diagnostics = Diagnostics(self)
        self.create_service(ListMotions, "~/list_motions", self._list_motions)
        self.create_service(QueueMotion, "~/queue_motion", self._queue_motion)
        self.create_service(Trigger, "~/clear_queue", self._clear_queue)
        self.create_timer(STATUS_PERIOD_S, self._publish_status)

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send a window sixty times a second until told to stop."""
        self.get_logger().info(f"ready: {len(self._library.names)} motions in {self._library.folder}")
        self._pacer.resume()
        while not stop:
            remaining_s = self._pacer.remaining_s()
            if remaining_s > 0:
                executor.spin_once(timeout_sec=remaining_s)
                continue
            self._pacer.begin()
            self._send(self._pacer.tick_time_ns)
            self._pacer.finish()

    def close(self) -> None:
        """Nothing is open."""

    def _send(self, time_ns: int) -> None:
        window = self._stitcher.next_frames(time_ns)
        message = to_target_frames(self._source, self._sequence, window.time_ns, 1.0 / RATE_HZ, window.frames)
        self._frames.publish(message)
        self._sequence += 1
        shown = (self._stitcher.playing.name, *self._stitcher.queued)
        if shown != self._shown:
            if self._shown and self._stitcher.empty:
                self.get_logger().info("the queue ran empty: stands and waits for a motion")
            self._shown = shown
            self._publish_status()

    def _list_motions(
        self, request: ListMotions.Request, response: ListMotions.Response
    ) -> ListMotions.Response:
        wanted = [name for name in self._library.names if request.pattern.lower() in name.lower()]
        for name in wanted:
            try:
                clip = self._library.get(name)
            except UniconError as error:
                self.get_logger().warning(str(error))
                continue
            response.motions.append(
                MotionInfo(
                    name=name,
                    duration=clip.duration_s,
                    label=clip.label,
                    source=clip.source,
                    licence=clip.licence,
                )
            )
        return response

    def _queue_motion(
        self, request: QueueMotion.Request, response: QueueMotion.Response
    ) -> QueueMotion.Response:
        try:
            clip = self._library.get(request.name)
            self._stitcher.queue(clip, request.transition)
            response.success = True
            response.message = f"queued {clip.name}, {clip.duration_s:.1f} s"
        except UniconError as error:
            response.success, response.message = False, str(error)
        playing = 1 if self._stitcher.playing.name else 0
        response.queue_length = len(self._stitcher.queued) + playing
        self._publish_status()
        return response

    def _clear_queue(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        count = len(self._stitcher.queued)
        self._stitcher.clear()
        response.success, response.message = (
            True,
            f"forgot {count} waiting motions; goes over to standing",
        )
        self._publish_status()
        return response

    def _publish_status(self) -> None:
        stitcher = self._stitcher
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
        statistics = self._pacer.statistics()
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


def main() -> int:
    """Run the stitching scheduler; return the exit status."""
    return run_node(StitchingNode, "stitching_node")
