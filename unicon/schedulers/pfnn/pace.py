"""From pace to gait: which gait it is to go so fast, for labels of training data and for the path ahead.

The pace is the root's speed along the ground plus ``TURN_M`` times its turn rate, so that stepping round on
the spot is no standing. A gait's weight falls to the next one's over a range of paces; all sum to 1.
"""

from __future__ import annotations

import numpy as np

from unicon.schedulers.pfnn.layout import GAITS

TURN_M = 0.4
"""Pace of a turn of 1 rad/s [m]."""
BETWEEN_M_S = {"walk": (0.15, 0.4), "jog": (1.75, 2.05), "run": (2.75, 3.0)}
"""From which to which pace a gait takes over from the slower one [m/s]."""


def gaits_at(speed: np.ndarray, turn_rate: np.ndarray) -> np.ndarray:
    """Return the weights of the gaits ``(..., 5)`` at speeds [m/s] and turn rates [rad/s] ``(...)``."""
    pace = speed + TURN_M * np.abs(turn_rate)
    above = {name: np.clip((pace - low) / (high - low), 0, 1) for name, (low, high) in BETWEEN_M_S.items()}
    weights = np.zeros((*pace.shape, len(GAITS)))
    weights[..., GAITS.index("stand")] = 1.0 - above["walk"]
    weights[..., GAITS.index("walk")] = above["walk"] - above["jog"]
    weights[..., GAITS.index("jog")] = above["jog"] - above["run"]
    weights[..., GAITS.index("run")] = above["run"]
    return weights
