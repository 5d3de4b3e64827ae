"""Speeds up no faster than a body can: the network goes from a walk to a jog within a step.

It learned both, and hardly a start of the one from the other. What is too fast is played slower as a whole,
root, phase and pose, so that feet that stand do not slide. Within a step the root's speed goes up and down,
so what is limited is its mean:

    share <- min(1, (mean + play) / speed)
    mean  <- mean + min(acceleration / 60, (share speed - mean) / (60 smooth))
"""

from __future__ import annotations

from dataclasses import dataclass

from unicon.motion.clip_index import RATE_HZ


@dataclass(frozen=True)
class PaceLimitConfig:
    """How fast it may speed up."""

    acceleration_m_s2: float = 1.6
    """Fastest rise of the mean speed [m/s^2]."""
    play_m_s: float = 0.25
    """So far above the mean the speed may be within a step [m/s]."""
    smooth_s: float = 0.15
    """Time over which the mean is taken."""


class PaceLimit:
    """The mean speed so far, and what it allows."""

    def __init__(self, config: PaceLimitConfig) -> None:
        self._config = config
        self.mean_m_s = 0.0

    def share(self, speed_m_s: float) -> float:
        """Return the share of a speed that is allowed in this frame, 0..1, and take it in."""
        allowed = self.mean_m_s + self._config.play_m_s
        share = min(1.0, allowed / speed_m_s) if speed_m_s > 0.0 else 1.0
        step = (share * speed_m_s - self.mean_m_s) / (RATE_HZ * self._config.smooth_s)
        self.mean_m_s += min(self._config.acceleration_m_s2 / RATE_HZ, step)
        return share
