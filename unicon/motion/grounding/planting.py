"""Holds feet still while they stand.

In contact, the point of contact (heel, ball, or in between as the foot rolls over) shall make no step,
and be on the floor. What the ankle has to be shifted by for that is the smallest smooth change that brings
it about: through the swing it passes from one step's shift to the next, so nothing pops. Where a leg is
too short for its shift, the root sinks a little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon.motion.grounding.smooth_change import SmoothChange, smooth_cover


@dataclass(frozen=True)
class PlantingConfig:
    """How feet are held."""

    smoothness_across: float = 0.3
    """Weight of the horizontal shift's second differences, against that of a slip in contact."""
    pull: float = 3e-5
    """Weight of the horizontal shift: a foot that drifts for more than about 3 s may slip, slowly."""
    largest_shift_m: float = 0.12
    """No foot is shifted further across; what a motion on the spot slides more than that, it slides."""
    smoothness_up: float = 10.0
    """Weight of the vertical shift's second differences, against that of a height in contact."""
    pull_up: float = 0.03
    """Weight of the vertical shift while a foot swings."""
    largest_drop_m: float = 0.06
    """The root sinks by no more than this for a leg that is too short."""
    drop_smoothness: float = 30.0
    """Weight of the drop's second differences."""


def foot_shift(
    steps_w: np.ndarray, heights: np.ndarray, contact: np.ndarray, config: PlantingConfig
) -> np.ndarray:
    """Return by how much to shift each ankle ``(T, 2, 3)`` [m] against the root.

    Args:
        steps_w: how far each point of contact moves to the next frame ``(T-1, 2, 3)`` [m].
        heights: of each foot over the floor ``(T, 2)`` [m].
        contact: when each foot stands ``(T, 2)``.
        config: weights.
    """
    shifts = [_shift(steps_w[:, i, :2], heights[:, i], contact[:, i], config) for i in range(2)]
    return np.stack(shifts, axis=1)


def root_drop(missing: np.ndarray, config: PlantingConfig) -> np.ndarray:
    """Return by how much the root sinks ``(T,)`` [m], given what each leg lacks in reach ``(T,)`` [m]."""
    if not missing.any():
        return np.zeros_like(missing)
    drop = smooth_cover(np.minimum(missing, config.largest_drop_m), config.drop_smoothness)
    return np.maximum(drop, 0.0)


def _shift(steps: np.ndarray, height: np.ndarray, contact: np.ndarray, config: PlantingConfig) -> np.ndarray:
    """Return one foot's shift ``(T, 3)`` [m]."""
    across = SmoothChange(len(contact), 2)
    across.want_steps(np.where(contact[1:] & contact[:-1], 1.0, 0.0), -steps)
    across.want_values(config.pull, 0.0)
    across.want_bends(config.smoothness_across, 0.0)
    on_floor = contact | (height < 0.0)
    up = SmoothChange(len(contact))
    up.want_values(np.where(on_floor, 1.0, config.pull_up), np.where(on_floor, -height, 0.0))
    up.want_bends(config.smoothness_up, 0.0)
    return np.concatenate([_limited(across.solve(), config.largest_shift_m), up.solve()], axis=1)


def _limited(shift: np.ndarray, largest: float) -> np.ndarray:
    """Return shifts ``(T, 2)`` of less than the largest length: d becomes d / (1 + (d / largest)^4)^(1/4)."""
    ratio = np.linalg.norm(shift, axis=-1, keepdims=True) / largest
    return shift / np.sqrt(np.sqrt(1.0 + ratio**4))
