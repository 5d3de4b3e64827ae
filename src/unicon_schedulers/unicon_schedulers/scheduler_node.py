"""What schedulers that play clips share: a library, and a stitcher's path to send."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rclpy.executors import Executor
from rich.console import Console

from unicon.motion.store.library_choice import open_library
from unicon.schedulers.stitching import Stitcher, StitcherConfig, Window
from unicon_ros.parameters import Parameter
from unicon_ros.process import StopFlag
from unicon_schedulers.target_stream_node import Playing, TargetStreamNode

LIBRARY = Parameter(
    "library", "", "folder of a clip library; empty for that of $UNICON_LIBRARY, or else the shipped one"
)
WINDOW = Parameter("window", 8, "frames in each message", "frames", 1, 64)
TRANSITION = Parameter(
    "transition_s",
    StitcherConfig.transition_s,
    "length of the transition into each clip for which no other is given",
    "s",
    0.0,
    5.0,
)


class SchedulerNode(TargetStreamNode):
    """A node that sends the path of its stitcher.

    Its table of parameters has ``library``, too.

    Raises:
        UniconError: when a parameter or the library cannot be used.
    """

    stitcher: Stitcher
    """The path; set by the node that knows what to play, before it runs."""

    def __init__(self, name: str, parameters: Sequence[Parameter]) -> None:
        super().__init__(name, parameters)
        library: str = self.values["library"]
        self.library = open_library(Path(library) if library else None, Console(stderr=True))

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send a window sixty times a second until told to stop."""
        self.get_logger().info(f"ready: {len(self.library.names)} motions in {self.library.folder}")
        super().run(executor, stop)

    def next_frames(self, time_ns: int) -> Window:
        """Return the stitcher's window."""
        return self.stitcher.next_frames(time_ns)

    def playing(self) -> Playing:
        """Return the stitcher's segment and queue."""
        stitcher = self.stitcher
        return Playing(stitcher.playing.name, stitcher.position_s, tuple(stitcher.queued), stitcher.empty)

    def facts(self) -> Mapping[str, object]:
        """Return how much waits."""
        return {"queued": len(self.stitcher.queued)}

    def changed(self, playing: Playing) -> None:
        """Say when it has nothing more to play."""
        if playing.empty:
            self.get_logger().info("nothing more to play: stands and waits for a motion")
