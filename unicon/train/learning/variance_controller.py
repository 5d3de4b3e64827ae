"""The policy variance controller (paper, section 4.4): how wide the exploration noise is.

A deviation that is learned freely shrinks too early or never. The controller makes its level follow a
schedule whose logarithm is linear between given points of the training, so that early training explores
and late training is precise:

controlled   each joint's log std is learned by gradient; before every iteration up to the last point all
             are shifted by the same amount, so that their mean is the schedule's. The paper's.
scheduled    every joint's log std is the schedule's, times its factor. Nothing is learned.
learned      learned from the first point's value on, without a controller: the ablation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from unicon.errors import UniconError


@dataclass(frozen=True)
class VarianceConfig:
    """How wide the policy's noise is."""

    mode: Literal["controlled", "scheduled", "learned"] = "scheduled"
    """Who decides: see above."""
    points: tuple[tuple[float, float], ...] = ((0.0, 0.16), (0.15, 0.10), (1.0, 0.045))
    """When, and the standard deviation then [shares of the largest torque]; log-linear in between."""
    axis: Literal["progress", "million_samples"] = "progress"
    """Unit of when: share of the budget that is spent, 0 to 1, or samples of all processes [1e6]."""
    joint_factors: tuple[float, ...] = ()
    """Times this for each action, in the humanoid's joint order; 1 for all where there are none."""

    def __post_init__(self) -> None:
        """Raise UniconError: when the schedule is not one."""
        times = [when for when, _ in self.points]
        if not times or times != sorted(set(times)):
            raise UniconError("variance.points: expected one or more points, each later than the one before")
        if (
            min((std for _, std in self.points), default=1.0) <= 0
            or min(self.joint_factors, default=1.0) <= 0
        ):
            raise UniconError("variance: the deviations and joint_factors must be above 0")


def scheduled_log_std(config: VarianceConfig, progress: float, samples: int, action_size: int) -> np.ndarray:
    """Return log(std) ``(A,)`` at a point of the training.

    Args:
        config: the schedule.
        progress: share of the budget that is spent.
        samples: samples of all processes so far.
        action_size: A.

    Raises:
        UniconError: when there are joint factors, but not one for each action.
    """
    if config.joint_factors and len(config.joint_factors) != action_size:
        raise UniconError(
            f"variance.joint_factors: got {len(config.joint_factors)} numbers, expected {action_size}"
        )
    now = progress if config.axis == "progress" else samples / 1e6
    times, deviations = np.array(config.points, float).T
    factors = np.array(config.joint_factors or np.ones(action_size))
    return np.interp(now, times, np.log(deviations)) + np.log(factors)


def control_log_std(config: VarianceConfig, log_std: np.ndarray, progress: float, samples: int) -> np.ndarray:
    """Return log(std) ``(A,)`` to explore with in the next iteration.

    controlled: ``log_std + (mean of the schedule - mean of log_std)``, until the last point is passed.

    Args:
        config: mode and schedule.
        log_std: as the last iteration left it ``(A,)``.
        progress: share of the budget that is spent.
        samples: samples of all processes so far.
    """
    if config.mode == "learned":
        return log_std
    wanted = scheduled_log_std(config, progress, samples, len(log_std))
    if config.mode == "scheduled":
        return wanted
    now = progress if config.axis == "progress" else samples / 1e6
    return log_std if now > config.points[-1][0] else log_std + (wanted.mean() - log_std.mean())
