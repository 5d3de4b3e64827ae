"""`ros2 run unicon_schedulers stitching_node`: plays queued clips as one endless stream of target frames."""

from __future__ import annotations

from std_srvs.srv import Trigger

from unicon.errors import UniconError
from unicon.schedulers.stitching import Stitcher, StitcherConfig
from unicon_msgs.msg import MotionInfo
from unicon_msgs.srv import ListMotions, QueueMotion
from unicon_ros.parameters import Parameter
from unicon_ros.process import run_node
from unicon_schedulers.scheduler_node import LIBRARY, TRANSITION, WINDOW, SchedulerNode

PARAMETERS = (
    LIBRARY,
    Parameter("queue", [""], "motions to begin with"),
    TRANSITION,
    WINDOW,
    Parameter("source", "stitching", "name under which the target frames are published"),
)


class StitchingNode(SchedulerNode):
    """The stitching scheduler.

    Raises:
        UniconError: when there is no library, or a motion of the parameter queue is not in it.
    """

    def __init__(self) -> None:
        super().__init__("stitching", PARAMETERS)
        config = StitcherConfig(window=self.values["window"], transition_s=self.values["transition_s"])
        self.stitcher = Stitcher(config, self.pacer.tick_time_ns)
        for name in filter(None, self.values["queue"]):
            self.stitcher.queue(self.library.get(name), config.transition_s)
        self.create_service(ListMotions, "~/list_motions", self._list_motions)
        self.create_service(QueueMotion, "~/queue_motion", self._queue_motion)
        self.create_service(Trigger, "~/clear_queue", self._clear_queue)

    def _list_motions(
        self, request: ListMotions.Request, response: ListMotions.Response
    ) -> ListMotions.Response:
        wanted = request.pattern.lower()
        response.motions = [
            MotionInfo(
                name=info.name,
                duration=info.seconds,
                label=info.label,
                source=info.source,
                licence=info.licence,
            )
            for info in sorted(self.library.infos, key=lambda info: info.name)
            if wanted in info.name.lower()
        ]
        return response

    def _queue_motion(
        self, request: QueueMotion.Request, response: QueueMotion.Response
    ) -> QueueMotion.Response:
        try:
            clip = self.library.get(request.name)
            self.stitcher.queue(clip, request.transition)
            response.success = True
            response.message = f"queued {clip.name}, {clip.duration_s:.1f} s"
        except UniconError as error:
            response.success, response.message = False, str(error)
        playing = 1 if self.stitcher.playing.name else 0
        response.queue_length = len(self.stitcher.queued) + playing
        self.publish_status()
        return response

    def _clear_queue(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        count = len(self.stitcher.queued)
        self.stitcher.clear()
        response.success, response.message = (
            True,
            f"forgot {count} waiting motions; goes over to standing",
        )
        self.publish_status()
        return response


def main() -> int:
    """Run the stitching scheduler; return the exit status."""
    return run_node(StitchingNode, "stitching_node")
