"""Gait labels of a take: those of its pace, faded into each other over time."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon.schedulers.pfnn.pace import gaits_at

SMOOTH_FRAMES = 8.0


def label_gaits(speed: np.ndarray, turn_rate: np.ndarray) -> np.ndarray:
    """Return the weights ``(T, 5)`` of the gaits.

    Args:
        speed: of the root along the ground, without the sway of single steps ``(T,)`` [m/s].
        turn_rate: of the heading, likewise ``(T,)`` [rad/s].
    """
    return gaussian_filter1d(gaits_at(speed, turn_rate), SMOOTH_FRAMES, axis=0, mode="nearest")
