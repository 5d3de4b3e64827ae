"""Where the body slides over the floor as a whole: the root drifts, or a program moved a held pose along.

Somebody who goes anywhere moves a limb against the others. Only wheels carry a body that doesn't.
"""

from __future__ import annotations

import numpy as np

from unicon.motion.cleaning.body_paths import BodyPaths
from unicon.motion.grounding.smooth_change import spans

WINDOW_S = 0.1
"""Velocities are measured over this time, in which no limb comes back to where it was."""
LEAST_SPEED = 0.05
"""Sliding is faster [m/s]; who just stands sways by less."""
SPREAD, LARGEST_SPREAD = 0.3, 0.15
"""The velocities of all parts differ from their mean by less than this share of it, and by less [m/s]."""
SHORTEST_S = 1.0
"""A long jump takes less, with its landing."""


def drifting(paths: BodyPaths) -> list[tuple[int, int]]:
    """Return where all parts slide alike, as pairs of the first frame and the one after the last."""
    window = max(round(WINDOW_S * paths.rate_hz), 1)
    if len(paths.times_s) <= window:
        return []
    ground_pos = paths.pos_w[:, paths.body_rows, :2]
    duration_s = paths.times_s[window:] - paths.times_s[:-window]
    velocity = (ground_pos[window:] - ground_pos[:-window]) / duration_s[:, None, None]
    mean = velocity.mean(axis=1)
    speed = np.linalg.norm(mean, axis=-1)
    spread = np.linalg.norm(velocity - mean[:, None], axis=-1).max(axis=1)
    alike = (spread < np.minimum(SPREAD * speed, LARGEST_SPREAD)) & (speed > LEAST_SPEED)
    found = [(start, stop + window) for start, stop in spans(alike)]
    return [(start, stop) for start, stop in found if stop - start >= SHORTEST_S * paths.rate_hz + window]
