"""Hinge angles from rotations: continuous in time, within limits where that can be, and never too fast.

For a body with hinges about the axes a, b, c the rotation is R_a(x) R_b(y) R_c(z). The same rotation has
the angles (x + pi, pi - y, z + pi). From frame to frame the nearer of the two is taken, and of the paths
that follow (two, and each angle by whole turns) the one that keeps best to the limits. Where none does,
because an arm went round once, the path may change between the two ways where that turns the body least
(hinge_path.py).

Where y is near a right angle the axes a and c are nearly parallel: x and z may then race in opposite
directions while the body hardly turns. There the fast passage is spread over the frames around: the path
minimises

    sum_t (dx^2 + 2 s dx dz + dz^2) + sum_t w (|x[t+1] - x[t]|^2 + |z[t+1] - z[t]|^2),

the turn (dx, dz) away from the exact rotation (s = +-sin y, the cosine between a and c) against the
rates, with a weight w that is zero but near the right angle. This is damped least squares (Nakamura and
Hanafusa 1986) over time.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from unicon import rotations
from unicon.motion.retargeting.hinge_path import find_path, limit_excess, nearest_turns

TOLERANCE_RAD = 0.05
"""A path may be beyond its limits by this much before another is looked for."""
SPINS_RAD = np.radians([0, -20, 20, -40, 40, -60, 60, -80, 80])
"""How far a limb may be spun about its length to keep within the limits."""
SPIN_COST = 0.5
"""Price of a squared radian of it, in radians beyond a limit."""
SPIN_SIGMA_FRAMES = 3.0
"""How smoothly it changes."""
NEAR_COSINE = 0.6
"""|cos y| below which the damping begins."""
DAMPING = 0.3
"""Its weight at the right angle."""
_RIDGE = 1e-6
"""Keeps the equations solvable where y is a right angle all the time."""


def hinge_angles(
    quat: np.ndarray, order: str, lower: np.ndarray, upper: np.ndarray, may_spin: bool = False
) -> np.ndarray:
    """Return the angles ``(T, 3)`` [rad] of rotations ``(T, 4)`` about three axes, e.g. "XZY".

    They follow the limits ``lower``, ``upper (3,)`` where there is a choice, but are not cut off at them. A
    body that ``may_spin`` gives up its turn about its own z axis rather than its direction where the limits
    forbid both.
    """
    first = _principal_angles(quat, order)
    second = _other_way(first)
    crossing = _distance(first[:-1], second[1:]) < _distance(first[:-1], first[1:])
    on_second = np.concatenate([[False], np.cumsum(crossing) % 2 == 1])[:, None]
    paths = [
        _place(np.unwrap(np.where(on_second == start, first, second), axis=0), lower, upper)
        for start in (False, True)
    ]
    best = min(paths, key=lambda path: float(limit_excess(path, lower, upper).sum()))
    parity = 1.0 if order in ("XYZ", "YZX", "ZXY") else -1.0
    if limit_excess(best, lower, upper).max() > TOLERANCE_RAD:
        best = _search(quat, order, parity, lower, upper, SPINS_RAD if may_spin else np.zeros(1))
    return _spread_races(best, parity)


def _search(
    quat: np.ndarray, order: str, parity: float, lower: np.ndarray, upper: np.ndarray, spins: np.ndarray
) -> np.ndarray:
    """Return the best path ``(T, 3)`` over both ways, whole turns and spins; the spin changes smoothly."""
    firsts = [_principal_angles(_spin(quat, np.full(len(quat), spin)), order) for spin in spins]
    ways = np.stack([angles for first in firsts for angles in (first, _other_way(first))])
    found = find_path(ways, np.repeat(SPIN_COST * spins**2, 2), parity, lower, upper)
    spin = spins[found.way // 2]
    if not spin.any():
        return found.angles
    smooth = gaussian_filter1d(spin, SPIN_SIGMA_FRAMES, mode="nearest")
    first = _principal_angles(_spin(quat, smooth), order)
    exact = np.where((found.way % 2 == 0)[:, None], first, _other_way(first))
    return nearest_turns(exact, found.angles)


def _spin(quat: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return rotations ``(T, 4)`` after a turn by ``angle (T,)`` about their own z axis."""
    return rotations.multiply(quat, rotations.from_heading(angle))


def _other_way(first: np.ndarray) -> np.ndarray:
    return first * np.array([1.0, -1.0, 1.0]) + np.pi


def ankle_angles(quat: np.ndarray) -> np.ndarray:
    """Return the angles ``(T, 2)`` [rad] about y, then x, that turn the z axis as rotations ``(T, 4)`` do.

    With n what becomes of that axis, sin x = -n_y and tan y = n_x / n_z. Where n_y is large y fades, so that
    it never races.
    """
    n = rotations.rotate(quat, np.array([0.0, 0.0, 1.0]))
    onward = np.maximum(n[:, 2], 0.0) + 0.5 * n[:, 1] ** 2
    return np.stack([np.arctan2(n[:, 0], onward), -np.arcsin(np.clip(n[:, 1], -1.0, 1.0))], axis=-1)


def _principal_angles(quat: np.ndarray, order: str) -> np.ndarray:
    """Return the angles ``(T, 3)`` [rad] of which the second is within a right angle."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        return Rotation.from_quat(rotations.wxyz_to_xyzw(quat)).as_euler(order)


def hinge_angle(quat: np.ndarray, axis: int) -> np.ndarray:
    """Return the turn ``(T,)`` [rad] about one axis (0, 1, 2) in rotations ``(T, 4)``: their twist."""
    return wrap(2.0 * np.arctan2(quat[:, 1 + axis], quat[:, 0]))


def wrap(angle_rad: np.ndarray) -> np.ndarray:
    """Return angles within -pi..pi."""
    return (angle_rad + np.pi) % (2.0 * np.pi) - np.pi


def _distance(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.abs(wrap(b - a)).sum(axis=-1)


def _place(path: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Return a continuous path shifted by the whole turns that keep each angle best within its limits."""
    shifts = [path + 2.0 * np.pi * k for k in (0, -1, 1)]
    costs = np.stack([limit_excess(shift, lower, upper).sum(axis=0) for shift in shifts])
    best = np.argmin(costs, axis=0)
    return np.stack([shifts[k][:, i] for i, k in enumerate(best)], axis=-1)


def _spread_races(path: np.ndarray, parity: float) -> np.ndarray:
    """Return the path ``(T, 3)`` with the first and third angle damped near the right angle of the second."""
    cosine = np.cos(path[:, 1])
    weight = DAMPING * np.maximum(1.0 - (cosine / NEAR_COSINE) ** 2, 0.0) ** 2
    if not weight.any() or len(path) < 2:
        return path
    coupling = parity * np.sin(path[:, 1])
    between = 0.5 * (weight[1:] + weight[:-1])
    # Unknowns x0, z0, x1, z1, ... : a symmetric matrix with two diagonals beside the main one.
    exact = path[:, [0, 2]]
    bands = np.zeros((3, 2 * len(path)))
    rates = np.zeros(len(path))
    rates[1:] += between
    rates[:-1] += between
    bands[0] = np.repeat(1.0 + _RIDGE + rates, 2)
    bands[1, ::2] = coupling
    bands[2, :-2] = np.repeat(-between, 2)
    goal = (1.0 + _RIDGE) * exact + coupling[:, None] * exact[:, ::-1]
    damped = solveh_banded(bands, goal.ravel(), lower=True).reshape(-1, 2)
    return np.stack([damped[:, 0], path[:, 1], damped[:, 1]], axis=-1)
