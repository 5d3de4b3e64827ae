"""A camera that follows without a jerk: it looks at a point that is smoothed over time, ahead and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon.motion.clip import RATE_HZ
from unicon.render.take import Take

LOOK_HEIGHT_M = 0.85
TOGETHER_M = 1.5


@dataclass(frozen=True)
class CameraConfig:
    """Where the camera stands."""

    azimuth_deg: float = 130.0
    """Direction in which it looks, about the vertical: 0 along x, 90 along y."""
    elevation_deg: float = -12.0
    """Negative: from above."""
    distance_m: float = 4.2
    smoothing_s: float = 0.6
    """How long (one sigma) its path is smoothed."""


def look_at(take: Take, config: CameraConfig) -> np.ndarray:
    """Return the points ``(T, 3)`` [m] that the camera looks at, smoothed.

    Between avatar and target while they are together; an avatar left lying is left behind.
    """
    centre = take.avatar.root_pos_w.copy()
    if take.target is not None:
        apart = take.target.root_pos_w - centre
        distance = np.linalg.norm(apart, axis=-1, keepdims=True)
        centre = take.target.root_pos_w - apart * 0.5 / np.maximum(distance / TOGETHER_M, 1.0)
    centre[:, 2] = LOOK_HEIGHT_M
    return gaussian_filter1d(centre, config.smoothing_s * RATE_HZ, axis=0, mode="nearest")
