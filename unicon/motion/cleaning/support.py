"""Whether the floor carries the body: what hangs, sits on something or stands on steps is told by the motion.

- Nothing near the floor for longer than any jump: something above or below carries it.
- At rest with the centre of mass beside everything that is lowest: it leans or sits on something.
- Feet that carry a straight leg at several heights: steps, or uneven ground.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_opening

from unicon.motion.cleaning.body_paths import BodyPaths
from unicon.motion.grounding.smooth_change import spans

_MASS = {
    "pelvis": 0.2,
    "chest": 0.3,
    "head": 0.08,
    "upper_arm": 0.027,
    "forearm": 0.016,
    "hand": 0.006,
    "thigh": 0.1,
    "shin": 0.047,
    "foot": 0.015,
}
"""Share of the body's mass that is put at a part's joint."""
_SIDED = ("foot", "toe", "shin", "thigh", "hand", "forearm", "upper_arm")
_LANDMARKS = ("pelvis", "chest", "head", *(f"{side}_{part}" for side in ("left", "right") for part in _SIDED))
_FEET = ("left_foot", "right_foot")
LOOK_HZ = 15.0
"""Nothing that matters here happens faster."""

AIR_S = 0.95
"""A jump of 1.1 m lasts as long."""
AIR_M = 0.4
"""What is higher than this over the floor touches nothing, however badly the floor is known."""
TOUCH_M = 0.13
"""What is not higher than this over the lowest joint may touch: joints lie inside the body."""
STILL_SPEED = 0.2
"""Of the centre of mass [m/s]; someone faster than this may be about to fall."""
BESIDE_M = 0.2
"""So far beside its support nobody is balanced."""
BESIDE_S = 1.0
SEAT_M = 0.33
"""The pelvis is this far over what is lowest when something carries it: else it sits or lies on the floor."""
STEP_M = 0.14
"""Feet on flat ground differ in height by less, tiptoes included."""
STAND_S = 0.2
STAND_SPEED = 0.15
"""A foot that carries weight is slower [m/s]."""
LEG_SHARE = 0.8
"""The hip is above a foot that carries weight by more than this share of the leg."""


def mass_centre(paths: BodyPaths) -> np.ndarray:
    """Return about where the centre of mass is ``(T, 3)`` [m]."""
    shares = {part: _MASS.get(part, _MASS.get(part.partition("_")[2], 0.0)) for part in paths.parts}
    parts = [part for part, share in shares.items() if share]
    weights = np.array([shares[part] for part in parts])
    return np.einsum("tpi,p->ti", paths.of(parts), weights / weights.sum())


class Support:
    """A motion looked at 15 times a second, with the floor at its lowest places."""

    def __init__(self, paths: BodyPaths) -> None:
        self._stride = max(round(paths.rate_hz / LOOK_HZ), 1)
        self._rate_hz = paths.rate_hz / self._stride
        self._paths = paths.take(slice(None, None, self._stride))
        self._marks = self._paths.of(_LANDMARKS)
        self._lowest = self._marks[..., 2].min(axis=1)
        self.floor = float(np.percentile(self._lowest, 2))
        """Height of the lowest joint when it touches [m]."""

    def longest_in_air(self) -> float:
        """Return the longest time [s] in which nothing is near the floor, and no foot stands on anything."""
        standing, _ = self._standing()
        return self._longest((self._lowest > self.floor + AIR_M) & ~standing)

    def longest_beside(self) -> float:
        """Return the longest rest [s] with the centre of mass beside what is lowest."""
        centre = mass_centre(self._paths)
        high = self._paths.pos("pelvis")[:, 2] > self._lowest + SEAT_M
        slow = high & (self._speed(centre) < STILL_SPEED)
        touching = self._marks[..., 2] < (self._lowest + TOUCH_M)[:, None]
        beside = np.zeros(len(slow), dtype=bool)
        beside[slow] = _distance(centre[slow], self._marks[slow], touching[slow]) > BESIDE_M
        return self._longest(beside)

    def standing_heights(self) -> np.ndarray:
        """Return the heights of the lower foot [m] in all frames in which it carries."""
        standing, height = self._standing()
        return height[standing]

    def _standing(self) -> tuple[np.ndarray, np.ndarray]:
        """Return in which frames ``(T,)`` the lower foot carries, and its height ``(T,)`` [m]."""
        feet = self._paths.of(_FEET)
        frames, lower = np.arange(len(feet)), np.argmin(feet[..., 2], axis=1)
        height, speed = feet[frames, lower, 2], self._speed(feet)[frames, lower]
        carries = self._paths.pos("pelvis")[:, 2] - height > LEG_SHARE * self._paths.leg_m
        enough = np.ones(max(round(STAND_S * self._rate_hz), 2))
        return binary_opening((speed < STAND_SPEED) & carries, enough), height

    def _speed(self, points: np.ndarray) -> np.ndarray:
        if len(points) < 2:
            return np.zeros(points.shape[:-1])
        return np.linalg.norm(np.gradient(points, axis=0), axis=-1) * self._rate_hz

    def _longest(self, mask: np.ndarray) -> float:
        return max((stop - start for start, stop in spans(mask)), default=0) / self._rate_hz


def _distance(centre: np.ndarray, marks: np.ndarray, touching: np.ndarray) -> np.ndarray:
    """Return how far the centre of mass is beside the lines between all points that touch ``(T,)`` [m]."""
    first, second = np.triu_indices(marks.shape[1])
    start, line = marks[:, first, :2], marks[:, second, :2] - marks[:, first, :2]
    arm = centre[:, None, :2] - start
    share = np.sum(arm * line, axis=-1) / np.maximum(np.sum(line * line, axis=-1), 1e-9)
    distance = np.linalg.norm(arm - np.clip(share, 0.0, 1.0)[..., None] * line, axis=-1)
    return np.where(touching[:, first] & touching[:, second], distance, np.inf).min(axis=1)
