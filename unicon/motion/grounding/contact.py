"""When a foot is on the floor, and whether on its heel or its ball.

A foot touches where the lower of its two points is near the floor and slow. Both are judged with two
thresholds (a contact begins under the tight one and lasts while under the loose one), and the speed
relative to that of the root, since the feet of skating motions slip the faster, the faster they run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_closing, binary_opening, maximum_filter1d

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics
from unicon.humanoid.table import BODIES
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.smooth_change import spans

FEET = ("left_foot", "right_foot")
"""Order of all arrays of feet."""


@dataclass(frozen=True)
class ContactConfig:
    """What counts as touching."""

    begin_height_m: float = 0.03
    """A contact begins only below this height."""
    end_height_m: float = 0.05
    """It ends above this height."""
    begin_speed: float = 0.35
    """It begins only below this speed [m/s], standing."""
    end_speed: float = 0.5
    """It ends above this speed [m/s], standing."""
    begin_speed_share: float = 0.08
    """Share of the root's speed that is added to the speed for beginning."""
    end_speed_share: float = 0.12
    """Share of the root's speed that is added to the speed for ending."""
    roll_m: float = 0.015
    """Where heel and ball differ less in height, both carry weight."""
    gap_s: float = 0.05
    """Shorter gaps in a contact are closed, shorter contacts are dropped."""


class Soles:
    """Heel and ball of both feet over T frames."""

    def __init__(self, bodies: BodyKinematics, roll_m: float = ContactConfig.roll_m) -> None:
        index = [HUMANOID.body_names.index(name) for name in FEET]
        rot_w, ankle_w = bodies.rot_w[:, index], bodies.pos_w[:, index]
        self.points_w = ankle_w[:, :, None] + np.einsum("tfij,kj->tfki", rot_w, SOLE_POINTS)
        """``(T, 2 feet, heel and ball, 3)`` [m]."""
        difference = self.points_w[..., 1, 2] - self.points_w[..., 0, 2]
        heel = np.clip(0.5 + 0.5 * difference / roll_m, 0.0, 1.0)
        self.up_b = rot_w[..., 2, :]
        """The world's up axis in the feet's frames ``(T, 2, 3)``."""
        self.weights = np.stack([heel, 1.0 - heel], axis=-1)
        """How much of the weight is on each point ``(T, 2, 2)``: all on the lower, half on each when flat."""

    @property
    def heights(self) -> np.ndarray:
        """Height of the lower point ``(T, 2)`` [m], on the lower edge of the sole."""
        return self.points_w[..., 2].min(axis=-1) - SOLE_HALF_WIDTH_M * np.abs(self.up_b[..., 1])

    def steps_w(self) -> np.ndarray:
        """Return how far the point of contact moves to the next frame ``(T-1, 2, 3)`` [m].

        The weighted mean of the steps of heel and ball: none for a foot that rolls over either.
        """
        weights = 0.5 * (self.weights[1:] + self.weights[:-1])
        return np.sum(weights[..., None] * np.diff(self.points_w, axis=0), axis=-2)

    def speeds(self) -> np.ndarray:
        """Return the speed of the point of contact ``(T, 2)`` [m/s]."""
        steps = np.linalg.norm(self.steps_w(), axis=-1) * RATE_HZ
        return np.concatenate([steps[:1], 0.5 * (steps[1:] + steps[:-1]), steps[-1:]])


_SOLE = next(body for body in BODIES if body.name == FEET[0]).shapes[0]
SOLE_HALF_WIDTH_M = _SOLE.end[1]
SOLE_POINTS = np.array(
    [[_SOLE.start[0] + along * _SOLE.end[0], 0.0, _SOLE.start[2] - _SOLE.end[2]] for along in (-1, 1)]
)
"""Heel and ball in a foot's frame ``(2, 3)`` [m]: the ends of its sole's middle line."""


def find_contacts(soles: Soles, root_pos_w: np.ndarray, config: ContactConfig) -> np.ndarray:
    """Return when each foot stands ``(T, 2)`` on the floor z = 0, with the sole facing down."""
    heights = np.where(soles.up_b[..., 2] > 0.0, soles.heights, np.inf)
    speeds = soles.speeds()
    pace = _pace(root_pos_w)[:, None]
    begins = (heights < config.begin_height_m) & (
        speeds < config.begin_speed + config.begin_speed_share * pace
    )
    lasts = (heights < config.end_height_m) & (speeds < config.end_speed + config.end_speed_share * pace)
    contact = np.stack([_grow(begins[:, i], begins[:, i] | lasts[:, i]) for i in range(2)], axis=1)
    return np.stack([_tidy(contact[:, i], round(config.gap_s * RATE_HZ)) for i in range(2)], axis=1)


def _pace(root_pos_w: np.ndarray) -> np.ndarray:
    """Return the root's largest horizontal speed ``(T,)`` [m/s] within a quarter of a second."""
    steps = np.linalg.norm(np.diff(root_pos_w[:, :2], axis=0), axis=-1) * RATE_HZ
    return maximum_filter1d(np.append(steps, steps[-1]), 31, mode="nearest")


def _grow(seeds: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Return the stretches of a mask that hold a seed."""
    grown = np.zeros_like(mask)
    for start, stop in spans(mask):
        grown[start:stop] = seeds[start:stop].any()
    return grown


def _tidy(mask: np.ndarray, gap: int) -> np.ndarray:
    """Close gaps and drop stretches of up to ``gap`` frames; those at the ends may go on beyond them."""
    if len(mask) <= 2 * gap:
        return mask
    element = np.ones(gap + 1, dtype=bool)
    padded = np.pad(mask, gap, mode="edge")
    return binary_opening(binary_closing(padded, element), element)[gap:-gap]
