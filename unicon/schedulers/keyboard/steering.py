"""Keeps to what was asked for: the network has habits, and a person should not have to correct them.

A network that learned from little data drifts to one side, and has its favourite speeds. So the facing that a
turn rate leads to is held, and what is missing in the velocity is added to what the network is asked for:

    facing   <- facing + rate / 60, kept within ``LEASH`` of where the root faces
    missing  <- missing + gain (commanded - achieved) / 60, within ``largest_m_s``

with the achieved velocity smoothed over a step. Both begin anew when the command changes. The commanded
velocity itself is approached no faster than a body can: by ``acceleration_m_s2``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.keyboard.command import LocomotionCommand

LEASH = 0.9
"""The facing that is asked for is at most so far from where the root faces [rad]."""
_NEW_M_S = 0.25
_BEGIN_M_S = 0.4


@dataclass(frozen=True)
class SteeringConfig:
    """How firmly it keeps to a command; gains of 0 leave all to the network."""

    gain: float = 1.0
    """Of what is missing in the velocity [1/s]."""
    largest_m_s: float = 0.6
    """Largest correction of each component of the velocity [m/s]."""
    smooth_s: float = 0.5
    """Time over which the achieved velocity is averaged."""
    acceleration_m_s2: float = 1.6
    """Fastest change of the velocity that is asked for [m/s^2]."""
    hold_heading: bool = True
    """Whether a facing is held where no turn is asked for."""


class Steering:
    """From a command to what the path is steered by."""

    def __init__(self, config: SteeringConfig, heading: float) -> None:
        self._config = config
        self._facing = heading
        self._last, self._wanted = np.zeros(2), np.zeros(2)
        self._achieved, self._missing = np.zeros(2), np.zeros(2)

    def steer(self, command: LocomotionCommand, heading: float) -> LocomotionCommand:
        """Return the command as the path shall see it.

        Args:
            command: what is asked for.
            heading: where the root faces [rad].
        """
        asked = np.array(command.velocity_h)
        if np.linalg.norm(asked - self._last) > _NEW_M_S:
            self._missing[:] = 0.0
        self._last = asked
        wanted = self._approach(asked)
        if command.stands and not wanted.any():
            self._facing = heading
            return command
        step = self._config.gain * (wanted - self._achieved) / RATE_HZ
        limit = self._config.largest_m_s
        self._missing = np.clip(self._missing + step, -limit, limit)
        forward, left = wanted + self._missing
        return replace(
            command, velocity_h=(float(forward), float(left)), facing_w=self._face(command, heading)
        )

    def _approach(self, asked: np.ndarray) -> np.ndarray:
        """Return the velocity on the way to what is asked for ``(2,)`` [m/s]."""
        if not self._wanted.any() and asked.any():
            # slower than this it would go on standing, and the key would not show
            self._wanted = asked * min(1.0, _BEGIN_M_S / float(np.linalg.norm(asked)))
        step = asked - self._wanted
        length = float(np.linalg.norm(step))
        largest = self._config.acceleration_m_s2 / RATE_HZ
        if length > largest:
            self._wanted = self._wanted + step * (largest / length)
            # nothing is missing yet that could be made up for
            self._missing *= 0.9
            self._achieved[:] = self._wanted
        else:
            self._wanted = asked
        return self._wanted

    def observe(self, velocity_h: np.ndarray) -> None:
        """Take in how fast the root went along the ground ``(2,)`` [m/s]."""
        share = 1.0 / (self._config.smooth_s * RATE_HZ)
        self._achieved += share * (velocity_h - self._achieved)

    def turn(self, angle: float) -> None:
        """Turn with the character that is placed elsewhere [rad]."""
        self._facing += angle

    def _face(self, command: LocomotionCommand, heading: float) -> float | None:
        if command.facing_w is not None or not self._config.hold_heading:
            self._facing = heading
            return command.facing_w
        facing = self._facing + command.turn_rate / RATE_HZ
        self._facing = float(np.clip(facing, heading - LEASH, heading + LEASH))
        return self._facing
