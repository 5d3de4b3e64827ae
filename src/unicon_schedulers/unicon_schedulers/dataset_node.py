"""`ros2 run unicon_schedulers dataset_node`: plays a library as the paper's dataset scheduler does, live."""

from __future__ import annotations

from std_srvs.srv import Trigger

from unicon.errors import UniconError
from unicon.schedulers.dataset import MAX_SPEED, MIN_SPEED, DatasetConfig, DatasetScheduler
from unicon.schedulers.stitching import StitcherConfig
from unicon_msgs.srv import Play
from unicon_ros.parameters import Parameter
from unicon_ros.process import run_node
from unicon_schedulers.scheduler_node import LIBRARY, TRANSITION, WINDOW, SchedulerNode

PARAMETERS = (
    LIBRARY,
    Parameter("play", "", "clip or class to begin with; empty for balanced random clips"),
    Parameter("speed", 1.0, "how many times as fast as captured", "", MIN_SPEED, MAX_SPEED),
    Parameter("loop", True, "one clip after the other without end; false: one clip, then it stands"),
    Parameter("seed", 0, "seed of the draws", "", 0, 999_999),
    TRANSITION,
    WINDOW,
    Parameter("source", "dataset", "name under which the target frames are published"),
)


class DatasetNode(SchedulerNode):
    """The dataset scheduler.

    Raises:
        UniconError: when there is no library, or nothing in it by the name of the parameter play.
    """

    def __init__(self) -> None:
        super().__init__("dataset", PARAMETERS)
        stitcher = StitcherConfig(window=self.values["window"], transition_s=self.values["transition_s"])
        config = DatasetConfig(self.values["seed"], stitcher)
        self._scheduler = DatasetScheduler(self.library, config, self.pacer.tick_time_ns)
        self.stitcher = self._scheduler.stitcher
        choice = self._scheduler.play(self.values["play"], self.values["speed"], self.values["loop"])
        self.get_logger().info(f"plays {choice.title}")
        self.create_service(Play, "~/play", self._play)
        self.create_service(Trigger, "~/stop", self._stop)

    def _play(self, request: Play.Request, response: Play.Response) -> Play.Response:
        try:
            speed = request.speed or self.values["speed"]
            choice = self._scheduler.play(request.what, speed, request.loop)
            response.success, response.clips = True, len(choice.infos)
            response.message = f"plays {choice.title}, {speed:g} times as fast as captured"
        except UniconError as error:
            response.success, response.message = False, str(error)
        self.publish_status()
        return response

    def _stop(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._scheduler.stop()
        response.success, response.message = True, "goes over to standing"
        self.publish_status()
        return response


def main() -> int:
    """Run the dataset scheduler; return the exit status."""
    return run_node(DatasetNode, "dataset_node")
