"""`ros2 run unicon_schedulers keyboard_node`: goes where keys, a gamepad or a program say, live."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Joy

from unicon.errors import UniconError
from unicon.schedulers.keyboard.command import LocomotionCommand
from unicon.schedulers.keyboard.foot_lock import FootLockConfig
from unicon.schedulers.keyboard.gamepad import GamepadProfile, command_of
from unicon.schedulers.keyboard.scheduler import KeyboardConfig, KeyboardScheduler
from unicon.schedulers.pfnn.network_file import find_network, read_network
from unicon.schedulers.stitching import Window
from unicon.tracking import TICK_NS
from unicon_msgs.msg import CharacterState as CharacterStateMessage
from unicon_msgs.msg import LocomotionCommand as LocomotionCommandMessage
from unicon_ros.conversion import from_stamp, to_state
from unicon_ros.parameters import Parameter
from unicon_ros.process import run_node
from unicon_ros.qos import COMMAND, STREAM_SUBSCRIBER
from unicon_schedulers.go_to_server import GoToServer
from unicon_schedulers.target_stream_node import Playing, TargetStreamNode

PARAMETERS = (
    Parameter("network", "pfnn", "name of a network under policies/, or its folder"),
    Parameter("stamped", False, "cmd_vel is a TwistStamped, not a Twist"),
    Parameter("timeout_s", 0.5, "a command holds for so long if it is not repeated", "s", 0.05, 10.0),
    Parameter("window", 2, "frames in each message; a command shows so many frames later", "frames", 1, 64),
    Parameter(
        "feedback",
        0.0,
        "share of the distance to the avatar that is made up in each frame while the reference goes",
        "",
        0.0,
        1.0,
    ),
    Parameter(
        "wait_m", 0.0, "lag of the avatar at which the reference stops and waits; 0: never", "m", 0.0, 10.0
    ),
    Parameter("foot_lock", False, "standing feet are held still, which the paper leaves off"),
    Parameter("source", "keyboard", "name under which the target frames are published"),
)
_STATES_APART, _STATES_APART_OPEN = 3, 6
"""One state in so many is decoded, closed loop and open: all would take longer than making the frames."""
_QUIET_S = 2.0
"""Between two complaints of the same kind."""


def config_of(values: Mapping[str, Any]) -> KeyboardConfig:
    """Return the scheduler's configuration by the node's parameters."""
    stop_m = values["wait_m"]
    return KeyboardConfig(
        window=values["window"],
        timeout_s=values["timeout_s"],
        feedback=values["feedback"],
        wait_m=(0.5 * stop_m, stop_m) if stop_m > 0.0 else None,
        foot_lock=FootLockConfig() if values["foot_lock"] else None,
    )


class KeyboardNode(TargetStreamNode):
    """The keyboard scheduler.

    Raises:
        UniconError: when a parameter or the network cannot be used.
    """

    def __init__(self) -> None:
        super().__init__("keyboard", PARAMETERS)
        card, network = read_network(find_network(self.values["network"]))
        config = config_of(self.values)
        self.scheduler = KeyboardScheduler(network, card, config, self.pacer.tick_time_ns)
        self._gamepad = GamepadProfile()
        self._rejected, self._clamped, self._gamepad_rests = 0, 0, True
        self._episode: int | None = None
        self._states = 0
        self._listen()
        self.go_to_server = GoToServer(self, self.scheduler)
        self.get_logger().info(f"ready: {card.name}, up to {card.limits.get('forward_m_s', 0.0):.1f} m/s")

    def _listen(self) -> None:
        if self.values["stamped"]:
            self.create_subscription(TwistStamped, "cmd_vel", lambda m: self._on_twist(m.twist), COMMAND)
        else:
            self.create_subscription(Twist, "cmd_vel", self._on_twist, COMMAND)
        self.create_subscription(LocomotionCommandMessage, "locomotion_command", self._on_command, COMMAND)
        self.create_subscription(Joy, "joy", self._on_joy, COMMAND)
        self.create_subscription(
            CharacterStateMessage, "state", self._on_raw_state, STREAM_SUBSCRIBER, raw=True
        )

    def next_frames(self, time_ns: int) -> Window:
        """Return the next poses."""
        window = self.scheduler.next_frames(time_ns)
        self.go_to_server.report()
        return window

    def playing(self) -> Playing:
        """Return the gait."""
        gait = self.scheduler.playing
        return Playing("" if gait == "stand" else gait, empty=gait == "stand")

    def facts(self) -> Mapping[str, object]:
        """Return how many commands were not obeyed as they came."""
        failures = self.scheduler.generator.failures
        return {"rejected": self._rejected, "clamped": self._clamped, "poses not finite": failures}

    def _on_twist(self, message: Twist) -> None:
        self._take(lambda: LocomotionCommand((message.linear.x, message.linear.y), message.angular.z))

    def _on_command(self, message: LocomotionCommandMessage) -> None:
        facing = message.facing - self.scheduler.anchor.turn if message.face else None
        velocity = message.forward, message.left
        self._take(lambda: LocomotionCommand(velocity, message.turn_rate, facing, message.gait))

    def _on_joy(self, message: Joy) -> None:
        try:
            command = command_of(message.axes, message.buttons, self._gamepad)
        except UniconError as error:
            self._reject(error)
            return
        # a gamepad that lies there does not hold back who uses the keys
        rests, self._gamepad_rests = self._gamepad_rests, command.stands
        if not (rests and command.stands):
            self._take(lambda: command)

    def _take(self, make: Callable[[], LocomotionCommand]) -> None:
        try:
            changes = self.scheduler.command(make(), time.time_ns())
        except UniconError as error:
            self._reject(error)
            return
        if changes:
            self._clamped += 1
            self.get_logger().warning(
                f"more than was trained: {', '.join(changes)}", throttle_duration_sec=_QUIET_S
            )

    def _reject(self, error: UniconError) -> None:
        self._rejected += 1
        self.get_logger().warning(f"rejected: {error}", throttle_duration_sec=_QUIET_S)

    def _on_raw_state(self, data: bytes) -> None:
        """Take in some of the states a second, more where they are fed back: most are not decoded."""
        self._states += 1
        closed_loop = self.values["feedback"] > 0.0 or self.values["wait_m"] > 0.0
        if self._states % (_STATES_APART if closed_loop else _STATES_APART_OPEN) == 0:
            self._on_state(deserialize_message(data, CharacterStateMessage))

    def _on_state(self, message: CharacterStateMessage) -> None:
        """Take in where the avatar is; after a reset begin anew where it stands."""
        if self._episode is not None and message.episode != self._episode:
            self.get_logger().info("the avatar was reset: stands and begins anew")
            self.go_to_server.end("the avatar was reset")
            self.scheduler.stop()
        self._episode = message.episode
        if message.source == self.values["source"]:
            avatar, target = to_state(message.actual), to_state(message.target)
            # actual and target hold one tick after the stamp
            self.scheduler.follow(avatar, target, from_stamp(message.header.stamp) + TICK_NS)


def main() -> int:
    """Run the keyboard scheduler; return the exit status."""
    return run_node(KeyboardNode, "keyboard_node")
