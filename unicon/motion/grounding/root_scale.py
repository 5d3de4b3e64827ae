"""Scales a clip's horizontal path so that its feet rest on the ground while they stand.

A standing foot at the place r relative to the root rests when the root's velocity is -dr/dt. Where a
motion comes from a body with other legs, root and legs disagree by a factor: the least-squares one
over the frames of stance, s = -sum(v . dr/dt) / sum(v . v), goes onto the root's path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles

_NEAR = 0.25


@dataclass(frozen=True)
class RootScaleConfig:
    """When and how far the path is scaled."""

    smallest: float = 0.8
    largest: float = 1.3
    travel_m: float = 0.5
    """The root has to travel this far while a foot stands, else the scale is 1."""
    speed: float = 0.3
    """Only frames in which the root is faster than this count [m/s]."""
    agreement: float = 0.6
    """This share of them, by weight, has to be near the median, else the scale is 1: feet glide or turn."""


def stance_ratio(
    soles: Soles, contact: np.ndarray, root_pos_w: np.ndarray, config: RootScaleConfig
) -> float | None:
    """Return the speed that standing feet give the root over the root's; None with too little to go by.

    Args:
        soles: the feet over T frames.
        contact: when each stands ``(T, 2)``.
        root_pos_w: the root's path ``(T, 3)`` [m].
        config: which frames count.
    """
    root = np.repeat(np.diff(root_pos_w, axis=0)[:, None, :2], 2, axis=1)
    legs = root - soles.steps_w()[..., :2]
    stands = contact[1:] & contact[:-1]
    counts = stands & (np.linalg.norm(root, axis=-1) * RATE_HZ > config.speed)
    root, legs = root[counts], legs[counts]
    if np.linalg.norm(root, axis=-1).sum() < config.travel_m:
        return None
    return _robust_ratio(np.sum(root * legs, axis=-1), np.sum(root * root, axis=-1), config.agreement)


def scale_path(root_pos_w: np.ndarray, scale: float) -> np.ndarray:
    """Return the path ``(T, 3)`` scaled horizontally about its first place."""
    factor = np.array([scale, scale, 1.0])
    return root_pos_w[:1] + factor * (root_pos_w - root_pos_w[:1])


def _robust_ratio(numerator: np.ndarray, denominator: np.ndarray, agreement: float) -> float | None:
    """Return sum(n) / sum(d) over the frames near the weighted median of n / d; None if those are few."""
    ratios = numerator / denominator
    order = np.argsort(ratios)
    below = np.cumsum(denominator[order])
    median = ratios[order][np.searchsorted(below, 0.5 * below[-1])]
    near = np.abs(ratios - median) <= _NEAR
    if denominator[near].sum() < agreement * denominator.sum():
        return None
    return float(numerator[near].sum() / denominator[near].sum())
