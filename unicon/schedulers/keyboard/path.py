"""The path that the character is steered along: one second behind it, and one ahead (Holden et al. 2017, 7).

121 frames at 60 Hz; frame ``HERE`` is the present. What lies behind is where the root was. What lies ahead is
in every frame what the network expects, drawn to what the command asks for, the more the farther ahead:

    step_i   <- (1 - w_p) step_i + w_p v / 60,      w_p = 1 - (1 - i/60)^position_bias
    facing_i <- facing_i + w_f (wanted_i - facing_i),   w_f = 1 - (1 - i/60)^facing_bias

with the steps from frame to frame ahead, i = 1..60, and v the commanded velocity seen from facing_i. Gaits
are those of the pace along the path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.keyboard.command import LocomotionCommand
from unicon.schedulers.keyboard.ground_plane import rotated
from unicon.schedulers.pfnn.layout import AHEAD, GAITS, PRESENT, SAMPLE_FRAMES, SAMPLES, PathSamples
from unicon.schedulers.pfnn.pace import gaits_at

HERE = 60
FRAMES = 121
_AHEAD_SHARE = np.arange(1, HERE + 1) / HERE
_SAMPLED = HERE + (np.arange(SAMPLES) - PRESENT) * SAMPLE_FRAMES
_STAND = GAITS.index("stand")


@dataclass(frozen=True)
class PathConfig:
    """How fast the path ahead follows the command."""

    position_bias: float = 3.0
    """Above 1 the near future follows the command sooner, below 1 later."""
    facing_bias: float = 2.0
    """Likewise, of the facing."""
    turn_s: float = 0.4
    """Time in which a facing that is asked for shall be reached from near [s]."""


class SteeredPath:
    """Position, facing and gait of 121 frames."""

    def __init__(self, config: PathConfig, pos_w: np.ndarray, heading: float, largest_turn: float) -> None:
        """Stand.

        Args:
            config: how it follows.
            pos_w: where ``(2,)`` [m].
            heading: facing where [rad].
            largest_turn: turn rate for a facing that is asked for [rad/s].
        """
        self._config, self._largest_turn = config, largest_turn
        self.pos_w = np.tile(np.asarray(pos_w, np.float64), (FRAMES, 1))
        self.heading = np.full(FRAMES, float(heading))
        self.gait = gaits_at(np.zeros(FRAMES), np.zeros(FRAMES))

    def steer(self, command: LocomotionCommand) -> None:
        """Draw what lies ahead to what a command asks for."""
        here = self.heading[HERE]
        wanted = here + command.turn_rate * _AHEAD_SHARE * (HERE / RATE_HZ)
        if command.facing_w is not None:
            wanted = self._towards(command.facing_w, wanted)
        ahead = self.heading[HERE + 1 :]
        turned = 1.0 - (1.0 - _AHEAD_SHARE) ** self._config.facing_bias
        self.heading[HERE + 1 :] = ahead + turned * (wanted - ahead)
        cos, sin = np.cos(self.heading[HERE + 1 :]), np.sin(self.heading[HERE + 1 :])
        forward, left = command.velocity_h
        velocity = np.stack([cos * forward - sin * left, sin * forward + cos * left], axis=-1)
        drawn = (1.0 - (1.0 - _AHEAD_SHARE) ** self._config.position_bias)[:, None]
        steps = np.diff(self.pos_w[HERE:], axis=0)
        steps += drawn * (velocity / RATE_HZ - steps)
        self.pos_w[HERE + 1 :] = self.pos_w[HERE] + np.cumsum(steps, axis=0)
        self._set_gaits_ahead()

    def samples(self) -> PathSamples:
        """Return the samples for the network, in the heading frame of the present."""
        offset = self.pos_w[_SAMPLED] - self.pos_w[HERE]
        turn = self.heading[_SAMPLED] - self.heading[HERE]
        facing_h = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        return PathSamples(rotated(offset, -self.heading[HERE]), facing_h, self.gait[_SAMPLED])

    @property
    def standing(self) -> float:
        """How much of standing is in what lies ahead, 0..1: 1 where nothing moves for the next second."""
        return float(self.gait[HERE:, _STAND].min())

    def advance(self, step_w: np.ndarray, turn: float, ahead_pos_h: np.ndarray, ahead_h: np.ndarray) -> None:
        """Go on to the next frame.

        Args:
            step_w: how far the root moved ``(2,)`` [m].
            turn: how far it turned [rad].
            ahead_pos_h: the network's samples from then on ``(6, 2)`` [m], in the new heading frame.
            ahead_h: their facings ``(6, 2)``.
        """
        pos_w, heading = self.pos_w[HERE] + step_w, self.heading[HERE] + turn
        for values in (self.pos_w, self.heading, self.gait):
            values[:HERE] = values[1 : HERE + 1]
            values[HERE:-1] = values[HERE + 1 :]
        at = np.arange(AHEAD) * SAMPLE_FRAMES
        frames = np.arange(1, HERE + 1)
        pos_h = np.stack(
            [_extended(frames, at, ahead_pos_h[:, i] - ahead_pos_h[0, i]) for i in range(2)], axis=-1
        )
        angle = np.unwrap(np.arctan2(ahead_h[:, 1], ahead_h[:, 0]))
        self.pos_w[HERE], self.heading[HERE] = pos_w, heading
        self.pos_w[HERE + 1 :] = pos_w + rotated(pos_h, heading)
        self.heading[HERE + 1 :] = heading + _extended(frames, at, angle - angle[0])

    def place(self, pos_w: np.ndarray, heading: float) -> None:
        """Turn and shift all of it so that the present is there."""
        turn = heading - self.heading[HERE]
        self.pos_w = np.asarray(pos_w) + rotated(self.pos_w - self.pos_w[HERE], turn)
        self.heading = self.heading + turn

    def _towards(self, facing: float, turning: np.ndarray) -> np.ndarray:
        """Return the headings ahead ``(60,)`` that approach a facing the shorter way, and go on turning."""
        here = self.heading[HERE]
        off = np.remainder(facing - here + np.pi, 2.0 * np.pi) - np.pi
        rate = min(abs(off) / self._config.turn_s, self._largest_turn)
        near = np.minimum(rate * _AHEAD_SHARE * (HERE / RATE_HZ), abs(off))
        return turning + np.sign(off) * near

    def _set_gaits_ahead(self) -> None:
        """Set the gaits from the present on to those of the pace there."""
        speed = np.linalg.norm(np.diff(self.pos_w[HERE:], axis=0), axis=-1) * RATE_HZ
        rate = np.diff(self.heading[HERE:]) * RATE_HZ
        self.gait[HERE + 1 :] = gaits_at(speed, rate)


def _extended(frames: np.ndarray, at: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return values at frames: linear between samples, and past the last one going on as before it."""
    inside = np.interp(frames, at, values)
    slope = (values[-1] - values[-2]) / (at[-1] - at[-2])
    return np.where(frames > at[-1], values[-1] + slope * (frames - at[-1]), inside)
