"""`ros2 run unicon_schedulers teleop_keyboard`: steers the character with the keys of a terminal."""

from __future__ import annotations

import signal
import time

from rclpy.executors import Executor
from rclpy.node import Node

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.key_table import action_of, banner, read_keys
from unicon.schedulers.keyboard.keyboard_pilot import KeyboardPilot, PilotConfig
from unicon_msgs.msg import CharacterState, ExecutorStatus
from unicon_msgs.msg import LocomotionCommand as LocomotionCommandMessage
from unicon_ros.conversion import to_stamp
from unicon_ros.parameters import Parameter, declare_parameters
from unicon_ros.process import StopFlag, run_node
from unicon_ros.qos import COMMAND, LATCHED
from unicon_schedulers.terminal import KeyTerminal

PARAMETERS = (
    Parameter("walk", PilotConfig.walk_m_s, "speed of a walk", "m/s", 0.1, 3.0),
    Parameter("jog", PilotConfig.jog_m_s, "speed of a jog", "m/s", 0.1, 5.0),
    Parameter("run", PilotConfig.run_m_s, "speed of a run", "m/s", 0.1, 6.0),
    Parameter("turn", PilotConfig.turn_rad_s, "turn rate of the turning keys", "rad/s", 0.1, 4.0),
)
PERIOD_S = 1.0 / 30.0
_MODES = {
    getattr(CharacterState, name): name.lower()
    for name in ("WAITING", "FOLLOWING", "HOLDING", "FALLEN", "PAUSED")
}


class TeleopKeyboard(Node):
    """Reads keys and sends commands.

    Raises:
        UniconError: when standard input is no terminal, or a parameter cannot be used.
    """

    def __init__(self) -> None:
        self._terminal = KeyTerminal()
        super().__init__("teleop_keyboard")
        values = declare_parameters(self, PARAMETERS)
        self._pilot = KeyboardPilot(
            PilotConfig(
                walk_m_s=values["walk"],
                jog_m_s=values["jog"],
                run_m_s=values["run"],
                turn_rad_s=values["turn"],
            )
        )
        self._publisher = self.create_publisher(LocomotionCommandMessage, "locomotion_command", COMMAND)
        self.create_subscription(ExecutorStatus, "status", self._on_status, LATCHED)
        self._avatar, self._moving = "no executor yet", False

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send what the keys ask for until Ctrl-C, or until the terminal goes away."""
        signal.signal(signal.SIGHUP, lambda number, frame: stop.set())
        print(banner(), flush=True)
        with self._terminal as terminal:
            while not stop:
                due_s = time.monotonic() + PERIOD_S
                try:
                    typed = terminal.read(PERIOD_S)
                except OSError:
                    break
                for key in read_keys(typed):
                    self._pilot.press(action_of(key), time.monotonic())
                self._send(self._pilot.command(time.monotonic()))
                executor.spin_once(timeout_sec=max(due_s - time.monotonic(), 0.0))
                terminal.show(self._line())
        self._publisher.publish(_message(STAND))

    def close(self) -> None:
        """Nothing is open."""

    def _send(self, command: LocomotionCommand) -> None:
        """Send a command while it moves, and one to stop."""
        if self._moving or not command.stands:
            self._publisher.publish(_message(command))
        self._moving = not command.stands

    def _line(self) -> str:
        pilot = self._pilot
        goes = "goes" if self._moving else "stands"
        gait = pilot.gait.value
        return f"{goes} | {gait} {pilot.speed_m_s:.2f} m/s x{pilot.factor:.2f} | {self._avatar}"

    def _on_status(self, message: ExecutorStatus) -> None:
        mode = _MODES.get(message.mode, str(message.mode))
        self._avatar = f"avatar {mode} {message.source or 'nothing'}"


def _message(command: LocomotionCommand) -> LocomotionCommandMessage:
    message = LocomotionCommandMessage(
        forward=command.velocity_h[0], left=command.velocity_h[1], turn_rate=command.turn_rate
    )
    message.header.stamp = to_stamp(time.time_ns())
    return message


def main() -> int:
    """Run the teleop; return the exit status."""
    return run_node(TeleopKeyboard, "teleop_keyboard")
