"""`ros2 run unicon_recorder recorder_node`: records every topic of an avatar into a rosbag2 folder."""

from __future__ import annotations

import importlib
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml
from ament_index_python.packages import get_package_share_directory
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_srvs.srv import Trigger

from unicon.errors import UniconError
from unicon.recording.bag_writer import BagWriter, Topic
from unicon.recording.continuity import Continuity
from unicon.recording.schema import full_definition
from unicon_msgs.srv import StartRecording
from unicon_ros.diagnostics import ERROR, OK, WARN, Diagnostics
from unicon_ros.parameters import Parameter, declare_parameters
from unicon_ros.process import PATIENCE_S, StopFlag, run_node
from unicon_ros.qos import ANYTHING, EVERYTHING, EVERYTHING_LATCHED

DISCOVERY_PERIOD_S = 0.25
DIAGNOSTICS_PERIOD_S = 1.0
DRAIN_S = 0.5
"""Longest time for taking in what waits when the recording ends."""
SHARED_TOPICS = ("/diagnostics", "/clock")
STATE, TARGETS = "unicon_msgs/msg/CharacterState", "unicon_msgs/msg/TargetFrames"

PARAMETERS = (
    Parameter("output", "", "folder of the bag; empty for recordings/<avatar>_<time>"),
    Parameter("start", True, "begin to record at once; otherwise by the service ~/start"),
    Parameter("exclude", "", "topics whose full name matches this regular expression are left out"),
)


class RecorderNode(Node):
    """The recorder.

    Raises:
        UniconError: when a parameter or the folder cannot be used.
    """

    def __init__(self) -> None:
        super().__init__("recorder")
        values = declare_parameters(self, PARAMETERS)
        self._output: str = values["output"]
        self._exclude = self._compile(values["exclude"])
        self._bag: BagWriter | None = None
        self._continuity = Continuity()
        self._taken: dict[str, Any] = {}
        self._definitions: dict[str, str] = {}
        self._trouble = ""
        self._diagnostics = Diagnostics(self)
        self.create_service(StartRecording, "~/start", self._start)
        self.create_service(Trigger, "~/stop", self._stop)
        self.create_timer(DISCOVERY_PERIOD_S, self._discover)
        self.create_timer(DIAGNOSTICS_PERIOD_S, self._publish_diagnostics)
        if values["start"]:
            self._begin(self._output)

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Record until told to stop."""
        while not stop:
            executor.spin_once(timeout_sec=PATIENCE_S)
            if self._bag is not None:
                self._keep_safe(self._bag)
        self._drain(executor)

    def _drain(self, executor: Executor) -> None:
        """Take in what was received before the signal."""
        deadline = time.monotonic() + DRAIN_S
        before = -1
        while self._bag is not None and time.monotonic() < deadline:
            if before == sum(self._bag.counts.values()):
                return
            before = sum(self._bag.counts.values())
            for _ in self._taken:
                executor.spin_once(timeout_sec=0)

    def close(self) -> None:
        """End the recording that runs."""
        if self._bag is not None:
            self._end()

    @staticmethod
    def _compile(pattern: str) -> re.Pattern[str] | None:
        try:
            return re.compile(pattern) if pattern else None
        except re.error as error:
            raise UniconError(f"the parameter exclude is no regular expression: {error}") from error

    def _begin(self, output: str) -> None:
        avatar = self.get_namespace().strip("/").replace("/", "_") or "avatar"
        default = Path("recordings") / f"{avatar}_{time.strftime('%Y-%m-%d_%H-%M-%S')}"
        self._bag = BagWriter(Path(output) if output else default)
        self._continuity = Continuity()
        self._trouble = ""
        self._forget_topics()
        self._discover()
        self.get_logger().info(f"records into {self._bag.folder}")

    def _end(self) -> None:
        assert self._bag is not None
        bag, self._bag = self._bag, None
        summary = self._continuity.summary()
        bag.close(summary)
        self._forget_topics()
        total = sum(bag.counts.values())
        proof = "; ".join(f"{stream}: {text}" for stream, text in summary.items())
        self.get_logger().info(f"ended {bag.folder}: {total} messages; {proof or 'no numbered streams'}")
        if sum(self._continuity.lost.values()):
            self.get_logger().error("messages were lost, see above")

    def _keep_safe(self, bag: BagWriter) -> None:
        try:
            bag.flush_when_due()
        except OSError as error:
            self._trouble = f"writing failed ({error.strerror})"
        if bag.full:
            self._trouble = "the disk is full"
        if self._trouble and self._bag is not None:
            self.get_logger().error(f"{self._trouble}: the recording ends here, what it has can be read")
            self._end()

    def _forget_topics(self) -> None:
        for subscription in self._taken.values():
            self.destroy_subscription(subscription)
        self._taken = {}

    def _discover(self) -> None:
        """Subscribe to every topic of the avatar that is new."""
        if self._bag is None:
            return
        prefix = self.get_namespace().rstrip("/") + "/"
        for name, types in self.get_topic_names_and_types():
            ours = name.startswith(prefix) or name in SHARED_TOPICS
            left_out = self._exclude is not None and self._exclude.search(name)
            if ours and not left_out and name not in self._taken and len(types) == 1:
                self._take(name, types[0])

    def _take(self, name: str, type_name: str) -> None:
        publishers = self.get_publishers_info_by_topic(name)
        if not publishers:
            return
        package, _, message = type_name.split("/")
        message_type = getattr(importlib.import_module(f"{package}.msg"), message)
        assert self._bag is not None
        profiles = yaml.safe_dump([_qos_entry(p.qos_profile) for p in publishers])
        type_hash = str(publishers[0].topic_type_hash)
        self._bag.add_topic(Topic(name, type_name, self._definition(type_name), type_hash, profiles))
        quality = _subscription_quality([p.qos_profile for p in publishers])
        callback = self._callback(name, type_name)
        self._taken[name] = self.create_subscription(message_type, name, callback, quality, raw=True)

    def _callback(self, name: str, type_name: str) -> Callable[[bytes, Any], None]:
        check = {STATE: self._see_state, TARGETS: self._see_targets}.get(type_name)

        def write(data: bytes, info: Any) -> None:
            if self._bag is None or self._bag.full:
                return
            if check is not None:
                check(data)
            times = (info["received_timestamp"], info["source_timestamp"])
            try:
                self._bag.write(name, data, *times)
            except OSError as error:
                self._trouble = f"writing failed ({error.strerror})"

        return write

    def _see_state(self, data: bytes) -> None:
        self._warn_of(self._continuity.see_state(data))

    def _see_targets(self, data: bytes) -> None:
        self._warn_of(self._continuity.see_targets(data))

    def _warn_of(self, gap: Any) -> None:
        if gap is not None:
            self.get_logger().error(
                f"lost {gap.found - gap.expected} messages of {gap.stream} before {gap.found}"
            )

    def _definition(self, type_name: str) -> str:
        if type_name not in self._definitions:
            self._definitions[type_name] = full_definition(type_name, _installed_definition)
        return self._definitions[type_name]

    def _start(
        self, request: StartRecording.Request, response: StartRecording.Response
    ) -> StartRecording.Response:
        if self._bag is not None:
            response.message = f"a recording runs already, into {self._bag.folder}: call ~/stop first"
            return response
        try:
            self._begin(request.output)
            response.success, response.message = True, str(self._bag.folder if self._bag else "")
        except UniconError as error:
            response.message = str(error)
        return response

    def _stop(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if self._bag is None:
            response.message = "no recording runs"
            return response
        folder = self._bag.folder
        self._end()
        response.success, response.message = True, f"ended {folder}"
        return response

    def _publish_diagnostics(self) -> None:
        lost = sum(self._continuity.lost.values())
        if self._trouble:
            level, message = ERROR, self._trouble
        elif self._bag is None:
            level, message = OK, "no recording runs"
        else:
            level, message = (WARN, f"{lost} messages lost") if lost else (OK, f"records {self._bag.folder}")
        self._diagnostics.publish(level, message, self._continuity.summary())


def _installed_definition(short: str) -> str:
    package, name = short.split("/")
    return (Path(get_package_share_directory(package)) / "msg" / f"{name}.msg").read_text()


def _subscription_quality(offered: list[QoSProfile]) -> QoSProfile:
    """Return the strictest subscription that all publishers match."""
    reliable = all(p.reliability == ReliabilityPolicy.RELIABLE for p in offered)
    latched = all(p.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in offered)
    if not reliable:
        return ANYTHING
    return EVERYTHING_LATCHED if latched else EVERYTHING


def _qos_entry(profile: QoSProfile) -> dict[str, object]:
    """Return a profile as rosbag2 writes it in metadata version 9."""
    forever = {"sec": 9223372036, "nsec": 854775807}
    return {
        "history": profile.history.name.lower(),
        "depth": profile.depth,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "deadline": forever,
        "lifespan": forever,
        "liveliness": profile.liveliness.name.lower(),
        "liveliness_lease_duration": forever,
        "avoid_ros_namespace_conventions": False,
    }


def main() -> int:
    """Run the recorder; return the exit status."""
    return run_node(RecorderNode, "recorder_node")
