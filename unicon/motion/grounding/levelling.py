"""Lays standing feet flat: their soles parallel to the floor, by the ankles alone.

A sole that stands on its edge comes from how the source's foot is built or was captured, and no body can
stand on it. Sideways tilt is taken out wherever a foot stands. Lengthwise tilt is left where the foot
rolls over heel or ball, and where someone stands on tiptoe; it is taken out where it is small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.leg_ik import SIDES, leg_of
from unicon.motion.grounding.smooth_change import SmoothChange


@dataclass(frozen=True)
class LevellingConfig:
    """Which tilts are taken out."""

    roll_rad: tuple[float, float] = (0.6, 1.0)
    """Sideways tilt up to the first is taken out, beyond the second it stays."""
    pitch_rad: tuple[float, float] = (0.15, 0.3)
    """Lengthwise tilt up to the first is taken out, beyond the second it stays."""
    smoothness: float = 30.0
    """Weight of the change's second differences."""
    pull: float = 1e-3
    """Weight of the change between contacts, where it goes over from one to the next."""


def level_feet(
    joint_pos: np.ndarray, soles: Soles, contact: np.ndarray, config: LevellingConfig
) -> np.ndarray:
    """Return the hinge angles ``(T, 35)`` with the standing feet level."""
    result = joint_pos.copy()
    for foot, side in enumerate(SIDES):
        ankle = leg_of(side).ankle
        x, y, z = soles.up_b[:, foot].T
        tilts = np.arctan2(x, np.hypot(y, z)), -np.arctan2(y, z)
        for hinge, tilt, limits in zip(ankle, tilts, (config.pitch_rad, config.roll_rad), strict=True):
            result[:, hinge] += _change(tilt, contact[:, foot], limits, config)
        result[:, ankle] = np.clip(result[:, ankle], HUMANOID.joint_lower[ankle], HUMANOID.joint_upper[ankle])
    return result


def _change(
    tilt: np.ndarray, contact: np.ndarray, limits: tuple[float, float], config: LevellingConfig
) -> np.ndarray:
    full, none = limits
    weight = contact * np.clip((none - np.abs(tilt)) / (none - full), 0.0, 1.0)
    problem = SmoothChange(len(tilt))
    problem.want_values(np.maximum(weight, config.pull), np.where(weight > config.pull, tilt, 0.0))
    problem.want_bends(config.smoothness, 0.0)
    return problem.solve()[:, 0]
