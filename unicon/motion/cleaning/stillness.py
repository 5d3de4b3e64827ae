"""Long stillness at the ends of a take: the actor waits for the camera."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import uniform_filter1d

from unicon.motion.cleaning.body_paths import BodyPaths

STILL_SPEED = 0.06
"""Mean speed of all parts, in someone who just stands [m/s]."""
LIVELY_SPEED = 0.3
"""The rest of the take has to be this fast now and then [m/s]: an idle take is all idle."""
LONGEST_S = 2.5
"""Shorter stillness stays."""
LEFT_S = 0.75
"""How much of it stays."""
SMOOTH_S = 0.4


def idle_ends(paths: BodyPaths) -> tuple[int, int]:
    """Return how many frames to cut at the beginning and at the end."""
    speeds = paths.speeds()[:, paths.body_rows].mean(axis=1)
    speeds = uniform_filter1d(speeds, max(round(SMOOTH_S * paths.rate_hz), 1), mode="nearest")
    lively = np.flatnonzero(speeds > STILL_SPEED)
    if len(lively) == 0 or np.percentile(speeds[lively[0] : lively[-1] + 1], 90) < LIVELY_SPEED:
        return 0, 0
    before, after = int(lively[0]), len(speeds) - 1 - int(lively[-1])
    left, longest = round(LEFT_S * paths.rate_hz), LONGEST_S * paths.rate_hz
    return tuple(count - left if count > longest else 0 for count in (before, after))  # pyright: ignore[reportReturnType]
