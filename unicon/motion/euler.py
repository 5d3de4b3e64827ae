"""Hinge angles from rotations: continuous in time, over both ways in which three angles give one rotation.

For a body with hinges about the axes a, b, c the rotation is R_a(x) R_b(y) R_c(z). The same rotation has
the angles (x + pi, pi - y, z + pi); of the two, and of all whole turns, the one nearest to the frame
before is taken. The first frame takes the one nearest to zero.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.spatial.transform import Rotation

from unicon import rotations


def hinge_angles(quat: np.ndarray, order: str) -> np.ndarray:
    """Return the angles ``(T, 3)`` [rad] of rotations ``(T, 4)`` about three axes, e.g. "XZY"."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        first = Rotation.from_quat(rotations.wxyz_to_xyzw(quat)).as_euler(order)
    second = first * np.array([1.0, -1.0, 1.0]) + np.pi
    return _nearest_path(first, second)


def _nearest_path(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    path = np.empty_like(first)
    before = np.zeros(3)
    for frame, candidates in enumerate(np.stack([first, second], axis=1)):
        steps = wrap(candidates - before)
        best = np.argmin(np.abs(steps).sum(axis=1))
        before = before + steps[best]
        path[frame] = before
    return path


def hinge_angle(quat: np.ndarray, axis: int) -> np.ndarray:
    """Return the turn ``(T,)`` [rad] about one axis (0, 1, 2) in rotations ``(T, 4)``: their twist."""
    return wrap(2.0 * np.arctan2(quat[:, 1 + axis], quat[:, 0]))


def wrap(angle_rad: np.ndarray) -> np.ndarray:
    """Return angles within -pi..pi."""
    return (angle_rad + np.pi) % (2.0 * np.pi) - np.pi
