"""Frames that were never captured: repeats of the one before, stretches that stand still or go on by rule."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from unicon import rotations
from unicon.motion.cleaning.body_paths import BodyPaths, turn_angles
from unicon.motion.grounding.smooth_change import spans

REPEAT_SHARE = 0.03
"""A frame repeats the one before when it changes by less than this share of what its neighbours do."""
REPEAT_REACH = 4
"""How many frames on either side count as neighbours."""
LEAST_CHANGE = 0.004
"""Neighbours have to change by more than this [rad or m], else it is just stillness."""
REGULAR_SHARE = 0.1
"""From this share of repeated frames on they are the rule, so that those at the ends are too."""
EXACT = 1e-6
"""Single repeats change by less [rad or m], since at a turning point everything is slow."""

STILL = 2e-4
"""What changes by less between frames is frozen [rad or m]: no person stands that still."""
SHORTEST_FROZEN_S = 0.25
BREAK = 0.02
"""Change between frames with which a motion stops or starts at once [rad or m]."""
WINDOW = 8
"""Frames over which speeds are compared; rounded angles need some."""
LINEAR_SHARE = 0.03
"""The ways over two windows differ by less than this share of the largest way."""
LEAST_LINEAR = 0.012
"""The largest way has to be longer [rad or m]."""


class Frozen(NamedTuple):
    """A stretch that was not captured."""

    start: int
    stop: int
    """The frame after the last one."""


def changes(paths: BodyPaths) -> np.ndarray:
    """Return how much each frame differs from the next ``(T-1,)``: the largest turn [rad] or step [m]."""
    turn = turn_angles(paths.local_quat).max(axis=1)
    step = np.linalg.norm(np.diff(paths.pos_w[:, 0], axis=0), axis=-1)
    return np.maximum(turn, step)


def repeated_frames(change: np.ndarray) -> np.ndarray:
    """Return which of T frames ``(T,)`` repeat the one before, in a motion that goes on around them.

    Where repeats are the rule they may be inexact, and those at the ends count; single ones have to be exact.
    """
    before, after = _largest_after(change[::-1])[::-1], _largest_after(change)
    usual = 2.0 * np.percentile(change, 90)  # one jump doesn't make all frames around it repeats
    small = change < REPEAT_SHARE * np.minimum(np.minimum(before, after), usual)
    repeats = small & (np.minimum(before, after) > LEAST_CHANGE)
    if repeats.mean() < REGULAR_SHARE:
        return np.concatenate([[False], repeats & (change < EXACT)])
    one_side = np.minimum(np.maximum(before, after), usual)
    number = np.arange(len(change))
    ends = np.minimum(number, number[::-1]) < REPEAT_REACH
    repeats |= ends & (change < REPEAT_SHARE * one_side) & (one_side > LEAST_CHANGE)
    return np.concatenate([[False], repeats])


def _largest_after(values: np.ndarray) -> np.ndarray:
    """Return the largest of the few values after each, 0 where there are none."""
    padded = np.pad(values[1:], (0, REPEAT_REACH))
    return sliding_window_view(padded, REPEAT_REACH).max(axis=1)


def still_stretches(change: np.ndarray, rate_hz: float) -> list[Frozen]:
    """Return the stretches of at least a quarter of a second in which nothing moves."""
    least = max(round(SHORTEST_FROZEN_S * rate_hz), 3)
    return [Frozen(start, stop + 1) for start, stop in spans(change < STILL) if stop - start >= least]


def breaks_off(change: np.ndarray, stretch: Frozen) -> bool:
    """Return whether the motion stops or starts at once there: holds made by hand are entered slowly."""
    around = [
        *change[max(stretch.start - 2, 0) : stretch.start],
        *change[stretch.stop - 1 : stretch.stop + 1],
    ]
    within = change[stretch.start : stretch.stop - 1].max()
    return bool(max(around) > BREAK + 3.0 * within)


def linear_stretches(paths: BodyPaths) -> list[Frozen]:
    """Return where every joint turns, and the root moves, at a constant speed over twice the window."""
    count = len(paths.times_s)
    if count < 2 * WINDOW + 1:
        return []
    turn = rotations.to_rotation_vector(
        rotations.multiply(rotations.conjugate(paths.local_quat[:-WINDOW]), paths.local_quat[WINDOW:])
    )
    step = paths.pos_w[WINDOW:, :1] - paths.pos_w[:-WINDOW, :1]
    ways = np.concatenate([turn, step], axis=1)
    bend = np.linalg.norm(ways[WINDOW:] - ways[:-WINDOW], axis=-1)
    size = np.linalg.norm(ways[:-WINDOW], axis=-1)
    fastest = size.max(axis=1)
    linear = (bend.max(axis=1) < LINEAR_SHARE * fastest) & (fastest > LEAST_LINEAR)
    return [Frozen(a, b + 2 * WINDOW) for a, b in spans(linear) if b - a >= WINDOW // 2]
