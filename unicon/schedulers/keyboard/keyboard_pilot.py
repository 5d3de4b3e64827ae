"""From held keys to a command: gait and speed are kept, moves last as long as their keys."""

from __future__ import annotations

from dataclasses import dataclass

from unicon.schedulers.keyboard.command import LocomotionCommand
from unicon.schedulers.keyboard.held_keys import HeldKeys
from unicon.schedulers.keyboard.key_table import MOVES, Action

_FACTOR = 1.1
_SLOWEST, _FASTEST = 0.4, 2.0


@dataclass(frozen=True)
class PilotConfig:
    """Speeds at a factor of 1."""

    walk_m_s: float = 1.2
    jog_m_s: float = 2.2
    run_m_s: float = 2.5
    back_m_s: float = 0.7
    side_m_s: float = 0.5
    turn_rad_s: float = 1.0


class KeyboardPilot:
    """What a person at the keys asks for."""

    def __init__(self, config: PilotConfig) -> None:
        self.config = config
        self.gait = Action.WALK
        """The gait that going forward has: WALK, JOG or RUN."""
        self.factor = 1.0
        """Of the speeds; changed by the speed keys."""
        self._keys = HeldKeys()

    def press(self, action: Action, time_s: float) -> None:
        """Take in that a key came."""
        if action in MOVES:
            self._keys.press(action, time_s)
        elif action in (Action.WALK, Action.JOG, Action.RUN):
            self.gait = action
        elif action in (Action.FASTER, Action.SLOWER):
            factor = self.factor * (_FACTOR if action is Action.FASTER else 1.0 / _FACTOR)
            self.factor = min(max(factor, _SLOWEST), _FASTEST)
        else:
            self._keys.release()

    @property
    def speed_m_s(self) -> float:
        """Forward, with the gait and factor as they are."""
        speeds = {
            Action.WALK: self.config.walk_m_s,
            Action.JOG: self.config.jog_m_s,
            Action.RUN: self.config.run_m_s,
        }
        return speeds[self.gait] * self.factor

    def command(self, time_s: float) -> LocomotionCommand:
        """Return what the keys that are held ask for; standing when none is."""
        held, config = self._keys.held(time_s), self.config
        forward = self.speed_m_s if Action.FORWARD in held else 0.0
        if Action.BACKWARD in held:
            forward = -config.back_m_s * self.factor
        left = config.side_m_s * self.factor * _sign(held, Action.STEP_LEFT, Action.STEP_RIGHT)
        turn = config.turn_rad_s * _sign(held, Action.TURN_LEFT, Action.TURN_RIGHT)
        return LocomotionCommand((forward, left), turn)


def _sign(held: set[Action], more: Action, less: Action) -> float:
    return float(more in held) - float(less in held)
