"""Takes jumps out of hinge angles: no hinge turns faster than a body ever does.

Jumps remain where a source's joint flips, or where an arm has gone round so often that its hinges must
be unwound. A step larger than the largest allowed is cut to it, and the rest of it spread evenly over
the frames around.
"""

from __future__ import annotations

import numpy as np

from unicon.motion.clip_index import RATE_HZ

FASTEST_RAD_S = 45.0
"""The fastest kicks and throws stay below this."""
RAMP_RAD_S = 20.0
"""How fast what is spread turns."""


PASSES = 3
"""Jumps close to each other add up, so what was spread is looked through again."""


def spread_jumps(angles: np.ndarray) -> np.ndarray:
    """Return hinge angles ``(T, n)`` at 60 Hz without steps far beyond what FASTEST_RAD_S allows."""
    most_rad = FASTEST_RAD_S / RATE_HZ
    for _ in range(PASSES):
        steps = np.diff(angles, axis=0)
        rest = steps - np.clip(steps, -most_rad, most_rad)
        if not rest.any():
            break
        angles = _spread(angles, rest)
    return angles


def _spread(angles: np.ndarray, jumps: np.ndarray) -> np.ndarray:
    """Return the angles with each of the jumps ``(T - 1, n)`` made a ramp around it."""
    spread, frames = angles.copy(), np.arange(len(angles))
    for frame, hinge in np.argwhere(jumps):
        jump = jumps[frame, hinge]
        count = min(int(np.ceil(abs(jump) * RATE_HZ / RAMP_RAD_S)), len(angles) - 1)
        first = int(np.clip(frame + 0.5 - 0.5 * count, 0, len(angles) - 1 - count))
        ramp = np.clip((frames - first) / count, 0.0, 1.0)
        spread[:, hinge] += jump * (ramp - (frames > frame))
    return spread
