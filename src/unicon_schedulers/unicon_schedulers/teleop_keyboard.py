"""`ros2 run unicon_schedulers teleop_keyboard`: steers the character with the keys of a terminal."""

from __future__ import annotations

import signal
import time

from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.node import Node

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.key_reader import KeyReader
from unicon.schedulers.keyboard.key_table import Action, action_of, banner
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
SILENT_S = 2.0
"""Statuses of the executor come twice a second; after so long without one it is gone."""
LAST_WORD = Duration(seconds=0.5)
"""Patience for the last command to be received; a command holds no longer without it."""
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
        self._keys = KeyReader()
        self._publisher = self.create_publisher(LocomotionCommandMessage, "locomotion_command", COMMAND)
        self.create_subscription(ExecutorStatus, "status", self._on_status, LATCHED)
        self._command = STAND
        self._avatar, self._heard_s = "", -SILENT_S

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Send what the keys ask for until Ctrl-C, or until the terminal goes away."""
        signal.signal(signal.SIGHUP, lambda number, frame: stop.set())
        due_s = time.monotonic()
        with self._terminal as terminal:
            terminal.write(banner() + "\n")
            while not stop:
                typed = terminal.read(due_s - time.monotonic())
                if typed is None:
                    break
                stops = self._press(typed)
                command, now_s = self._pilot.command(time.monotonic()), time.monotonic()
                # a change is not kept waiting for the next turn
                if stops or now_s >= due_s or command != self._command:
                    self._send(command, stops)
                    due_s = now_s + PERIOD_S
                    terminal.show(self._line(now_s))
                executor.spin_once(timeout_sec=0.0)
        self._send(STAND)
        # who leaves at once takes along what was not received yet
        self._publisher.wait_for_all_acked(LAST_WORD)

    def close(self) -> None:
        """Nothing is open."""

    def _press(self, typed: str) -> bool:
        """Take what was typed; return whether there was a key that stops."""
        now_s = time.monotonic()
        actions = [action_of(key) for key in self._keys.read(typed, now_s)]
        for action in actions:
            self._pilot.press(action, now_s)
        return Action.STOP in actions

    def _send(self, command: LocomotionCommand, stops: bool = False) -> None:
        """Send a command while it moves, and one to stop; a key that stops ends a go-to as well."""
        if stops or command != STAND or self._command != STAND:
            self._publisher.publish(_message(command))
        self._command = command

    def _line(self, now_s: float) -> str:
        pilot = self._pilot
        goes = "stands" if self._command.stands else "goes"
        gait = pilot.gait.value
        return f"{goes} | {gait} {pilot.speed_m_s:.2f} m/s x{pilot.factor:.2f} | {self._whom(now_s)}"

    def _whom(self, now_s: float) -> str:
        """Say who takes the commands, as far as that is known."""
        if not self._publisher.get_subscription_count():
            return f"nobody listens to {self._publisher.topic_name}"
        return self._avatar if now_s - self._heard_s < SILENT_S else "no executor"

    def _on_status(self, message: ExecutorStatus) -> None:
        mode = _MODES.get(message.mode, str(message.mode))
        self._avatar = f"avatar {mode} {message.source or 'nothing'}"
        self._heard_s = time.monotonic()


def _message(command: LocomotionCommand) -> LocomotionCommandMessage:
    message = LocomotionCommandMessage(
        forward=command.velocity_h[0], left=command.velocity_h[1], turn_rate=command.turn_rate
    )
    message.header.stamp = to_stamp(time.time_ns())
    return message


def main() -> int:
    """Run the teleop; return the exit status."""
    return run_node(TeleopKeyboard, "teleop_keyboard")
