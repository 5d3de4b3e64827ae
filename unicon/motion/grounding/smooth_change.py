"""The smallest smooth change of a path that brings about what is wanted, by linear least squares.

Asked for are values, steps and bends (second differences) of a path x[0..T-1], each with a weight:

    sum w_v (x[t] - v)^2 + sum w_s (x[t+1] - x[t] - s)^2 + sum w_b (x[t-1] - 2 x[t] + x[t+1] - b)^2

Its normal equations have five diagonals and are solved in one pass, so that it takes as long as a
filter. Unlike one it needs nothing beyond the path's ends: they go on as they are, neither slowed nor
pulled towards a padding (a smoothing spline; Whittaker 1923, Eilers 2003).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded


class SmoothChange:
    """Collects what is wanted of a path of T values with any number of components."""

    def __init__(self, count: int, components: int = 1) -> None:
        self._bands = np.zeros((3, count))
        """The diagonal in row 2, above it the first and second diagonals beside it."""
        self._right = np.zeros((count, components))

    def want_values(self, weight: np.ndarray | float, values: np.ndarray | float) -> None:
        """Ask for values ``(T,)`` or ``(T, C)`` with weights ``(T,)``."""
        self._add(np.ones(1), weight, values)

    def want_steps(self, weight: np.ndarray | float, steps: np.ndarray | float) -> None:
        """Ask for differences ``(T-1,)`` or ``(T-1, C)`` to the next value, with weights ``(T-1,)``."""
        self._add(np.array([-1.0, 1.0]), weight, steps)

    def want_bends(self, weight: np.ndarray | float, bends: np.ndarray | float) -> None:
        """Ask for second differences ``(T-2,)`` or ``(T-2, C)``, with weights ``(T-2,)``."""
        self._add(np.array([1.0, -2.0, 1.0]), weight, bends)

    def solve(self) -> np.ndarray:
        """Return the path ``(T, C)``.

        What is wanted has to determine it: some value everywhere, be its weight ever so small.
        """
        return solveh_banded(self._bands, self._right, overwrite_ab=True, overwrite_b=True)

    def _add(self, stencil: np.ndarray, weight: np.ndarray | float, wanted: np.ndarray | float) -> None:
        size, count = len(stencil), self._bands.shape[1]
        rows = count - size + 1
        if rows < 1:
            return
        weight = np.broadcast_to(weight, rows)
        wanted = np.asarray(wanted, dtype=float)
        wanted = np.broadcast_to(
            wanted if wanted.ndim == 2 else wanted[..., None], (rows, self._right.shape[1])
        )
        for i in range(size):
            self._right[i : i + rows] += (stencil[i] * weight)[:, None] * wanted
            for j in range(i, size):
                self._bands[2 - (j - i), j : j + rows] += stencil[i] * stencil[j] * weight


def smooth_cover(wanted: np.ndarray, smoothness: float, loose: float = 0.05, rounds: int = 6) -> np.ndarray:
    """Return a smooth path ``(T,)`` that is hardly anywhere below another, and near it.

    Where it is above, its error counts less; which frames those are is found in rounds.

    Args:
        wanted: what to cover ``(T,)``.
        smoothness: weight of second differences against an error below.
        loose: weight of an error above.
        rounds: how often it is solved.
    """
    path = wanted
    for _ in range(rounds):
        problem = SmoothChange(len(wanted))
        problem.want_values(np.where(path > wanted, loose, 1.0), wanted)
        problem.want_bends(smoothness, 0.0)
        path = problem.solve()[:, 0]
    return path


def spans(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return where a mask ``(T,)`` holds, as pairs of the first frame and the one after the last."""
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edges == 1).tolist(), np.flatnonzero(edges == -1).tolist(), strict=True))
