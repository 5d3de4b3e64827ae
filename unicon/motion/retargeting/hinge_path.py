"""The best path through all the ways in which three hinges give nearly the same rotations.

At each frame there are several triples of angles: two for the rotation itself, two for each spin of the
body about its own length that may be given up for the sake of the limits, and each with whole turns
added or taken away. A path pays for angles beyond their limits and for spins at every frame, and from
frame to frame for the square of how far the body would turn if the angles went the straight way from one
to the next,

    d^2 = dx^2 + dy^2 + dz^2 + 2 s dx dz,   s = +-sin y the cosine between the first and the third axis,

so that changing over costs little where the two axes are parallel. The cheapest path is found as by
Viterbi (1967).
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

TURN_COST, RATE_COST = 6.0, 0.15
"""Price of a squared radian that the body turns and of one that a hinge turns, in radians beyond a limit."""
FAR_RAD, FAR_COST = 4.0, 1e3
"""A hinge never jumps further than this."""
MUCH_RAD = 2.0
"""Candidates that are always further beyond the limits are left out."""


class HingePath(NamedTuple):
    """A path over time."""

    angles: np.ndarray
    """``(T, 3)`` [rad]."""
    way: np.ndarray
    """Which of the ways it takes at each frame ``(T,)``."""


class _Candidates(NamedTuple):
    angles: np.ndarray
    """``(C, T, 3)``."""
    way: np.ndarray
    """``(C,)``."""


def limit_excess(path: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Return how far angles ``(..., 3)`` are beyond their limits."""
    return np.maximum(lower - path, 0.0) + np.maximum(path - upper, 0.0)


def find_path(
    ways: np.ndarray, prices: np.ndarray, parity: float, lower: np.ndarray, upper: np.ndarray
) -> HingePath:
    """Return the cheapest path through the ways ``(W, T, 3)``, each with its price ``(W,)`` a frame."""
    candidates = _candidates(ways, lower, upper)
    angles = candidates.angles
    node = limit_excess(angles, lower, upper).sum(axis=-1) + prices[candidates.way, None]
    coupling = parity * np.sin(angles[..., 1])
    count = angles.shape[1]
    cost, back = node[:, 0], np.zeros(node.T.shape, dtype=int)
    for frame in range(1, count):
        step = angles[None, :, frame] - angles[:, None, frame - 1]
        total = cost[:, None] + _step_cost(step, coupling[:, frame])
        back[frame] = np.argmin(total, axis=0)
        cost = np.min(total, axis=0) + node[:, frame]
    chosen = [int(np.argmin(cost))]
    for frame in range(count - 1, 0, -1):
        chosen.append(int(back[frame, chosen[-1]]))
    chosen = chosen[::-1]
    return HingePath(angles[chosen, np.arange(count)], candidates.way[chosen])


def nearest_turns(angles: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Return the angles shifted by whole turns to be nearest to ``target``."""
    return angles - 2.0 * np.pi * np.round((angles - target) / (2.0 * np.pi))


def _candidates(ways: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> _Candidates:
    """Return all triples worth a look: near the middle of the limits, and a turn off."""
    near = nearest_turns(ways, 0.5 * (lower + upper))
    turns = 2.0 * np.pi * np.array(list(product((0, -1, 1), repeat=3)))
    every = (near[:, None] + turns[None, :, None]).reshape(-1, *ways.shape[1:])
    worth = limit_excess(every, lower, upper).max(axis=-1).min(axis=-1) < MUCH_RAD
    # Without a spin any may be the only way; with one it has to help by being within the limits somewhere.
    spun = np.repeat(np.arange(len(ways)), len(turns)) >= 2
    worth &= ~spun | (limit_excess(every, lower, upper).max(axis=-1).min(axis=-1) == 0.0)
    return _Candidates(every[worth], np.repeat(np.arange(len(ways)), len(turns))[worth])


def _step_cost(step: np.ndarray, coupling: np.ndarray) -> np.ndarray:
    """Return what steps ``(C, C, 3)`` cost."""
    x, y, z = step[..., 0], step[..., 1], step[..., 2]
    turn = x * x + y * y + z * z + 2.0 * coupling * x * z
    far = np.abs(step).max(axis=-1) > FAR_RAD
    return TURN_COST * turn + RATE_COST * np.abs(step).sum(axis=-1) + FAR_COST * far
