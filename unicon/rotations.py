"""Quaternions ``(..., 4)`` in the order w, x, y, z, for numpy and torch alike.

A rotation by the angle a about the unit axis n is q = (cos a/2, n sin a/2). Products compose from the
right: ``rotate(multiply(a, b), v) == rotate(a, rotate(b, v))``. Every function broadcasts over leading
dimensions. This is the only module that knows the order x, y, z, w of ROS messages and scipy.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from unicon.arrays import array_namespace

Array = Any
"""A numpy array or a torch tensor."""

_TINY = 1e-12


# Products as sums of terms sign * a[i] * b[j], a row for each component of the result.
_HAMILTON = (
    "+ww -xx -yy -zz",
    "+wx +xw +yz -zy",
    "+wy -xz +yw +zx",
    "+wz +xy -yx +zw",
)
_CROSS = ("+yz -zy", "+zx -xz", "+xy -yx")
_MATRIX = (
    *("+ww +xx -yy -zz", "+xy +xy -wz -wz", "+xz +xz +wy +wy"),
    *("+xy +xy +wz +wz", "+ww -xx +yy -zz", "+yz +yz -wx -wx"),
    *("+xz +xz -wy -wy", "+yz +yz +wx +wx", "+ww -xx -yy +zz"),
)


def _build_table(rows: tuple[str, ...], letters: str) -> np.ndarray:
    """Return ``(n * n, rows)``: the sign of each product a[i] b[j] in each component."""
    table = np.zeros((len(letters), len(letters), len(rows)))
    for component, row in enumerate(rows):
        for sign, i, j in row.split():
            table[letters.index(i), letters.index(j), component] += 1.0 if sign == "+" else -1.0
    return table.reshape(-1, len(rows))


_TABLES = {
    "hamilton": _build_table(_HAMILTON, "wxyz"),
    "cross": _build_table(_CROSS, "xyz"),
    "matrix": _build_table(_MATRIX, "wxyz"),
    "rot6d": _build_table(tuple(_MATRIX[i] for i in (0, 3, 6, 1, 4, 7)), "wxyz"),
}


@cache
def _table(name: str, xp: Any, dtype: Any, device: Any) -> Array:
    return xp.asarray(_TABLES[name], dtype=dtype, device=device)


def _contract(a: Array, b: Array, name: str) -> Array:
    """Return the bilinear product of the table ``name``.

    All products a[i] b[j] at once, then their signed sums by one matrix: three array operations where
    the written-out formula takes forty, which is most of the time of a control tick.
    """
    xp = array_namespace(a, b)
    products = a[..., :, None] * b[..., None, :]
    flat = xp.reshape(products, (*products.shape[:-2], products.shape[-1] * products.shape[-2]))
    return flat @ _table(name, xp, products.dtype, products.device)


def normalize(q: Array) -> Array:
    """Return ``q (..., 4)`` scaled to unit length."""
    xp = array_namespace(q)
    return q / xp.sqrt(xp.sum(q * q, axis=-1, keepdims=True))


def conjugate(q: Array) -> Array:
    """Return the inverse rotation of the unit quaternion ``q (..., 4)``."""
    xp = array_namespace(q)
    return xp.concat([q[..., :1], -q[..., 1:]], axis=-1)


def multiply(a: Array, b: Array) -> Array:
    """Return the Hamilton product ``a b (..., 4)``: first the rotation b, then a."""
    return _contract(a, b, "hamilton")


def cross(a: Array, b: Array) -> Array:
    """Return the cross product of vectors ``(..., 3)``, broadcasting."""
    return _contract(a, b, "cross")


def rotate(q: Array, v: Array) -> Array:
    """Turn the vectors ``v (..., 3)`` by ``q (..., 4)``: v + 2w (u x v) + 2 u x (u x v), u = q's vector."""
    u = q[..., 1:]
    t = 2.0 * cross(u, v)
    return v + q[..., :1] * t + cross(u, t)


def rotate_inverse(q: Array, v: Array) -> Array:
    """Turn the vectors ``v (..., 3)`` by the inverse of ``q (..., 4)``."""
    u = q[..., 1:]
    t = 2.0 * cross(u, v)
    return v - q[..., :1] * t + cross(u, t)


def from_axis_angle(axis: Array, angle: Array) -> Array:
    """Return the rotation ``(..., 4)`` by ``angle (...)`` [rad] about the unit ``axis (..., 3)``."""
    xp = array_namespace(axis, angle)
    half = 0.5 * angle[..., None]
    vector = xp.sin(half) * axis
    scalar = xp.cos(half) + 0.0 * vector[..., :1]
    return xp.concat([scalar, vector], axis=-1)


def from_rotation_vector(v: Array) -> Array:
    """Exponential map: the rotation by ``|v|`` [rad] about ``v (..., 3)``."""
    xp = array_namespace(v)
    half = 0.5 * xp.sqrt(xp.sum(v * v, axis=-1, keepdims=True))
    small = half < 1e-6
    safe = xp.where(small, xp.ones_like(half), half)
    sinc = xp.where(small, 1.0 - half * half / 6.0, xp.sin(safe) / safe)
    return xp.concat([xp.cos(half), 0.5 * sinc * v], axis=-1)


def to_rotation_vector(q: Array) -> Array:
    """Logarithmic map: axis times angle ``(..., 3)`` [rad], the angle within 0..pi."""
    xp = array_namespace(q)
    q = xp.where(q[..., :1] < 0.0, -q, q)
    u, w = q[..., 1:], q[..., :1]
    sine = xp.sqrt(xp.sum(u * u, axis=-1, keepdims=True))
    small = sine < 1e-6
    safe = xp.where(small, xp.ones_like(sine), sine)
    factor = xp.where(small, 2.0 / xp.where(small, w, xp.ones_like(w)), 2.0 * xp.atan2(sine, w) / safe)
    return factor * u


def angle(q: Array) -> Array:
    """Return the rotation angle ``(...)`` of ``q (..., 4)``, within 0..pi [rad]."""
    xp = array_namespace(q)
    sine = xp.sqrt(xp.sum(q[..., 1:] * q[..., 1:], axis=-1))
    return 2.0 * xp.atan2(sine, xp.abs(q[..., 0]))


def to_matrix(q: Array) -> Array:
    """Return the rotation matrices ``(..., 3, 3)`` of the unit quaternions ``q (..., 4)``."""
    xp = array_namespace(q)
    return xp.reshape(_contract(q, q, "matrix"), (*q.shape[:-1], 3, 3))


def from_matrix(matrix: Array) -> Array:
    """Return the quaternions ``(..., 4)``, w >= 0, of the rotation matrices ``(..., 3, 3)``.

    Each of the four classical formulas divides by one component; the largest one is used, so that the
    result is accurate for every rotation (Shepperd 1978).
    """
    xp = array_namespace(matrix)
    m = [[matrix[..., i, j] for j in range(3)] for i in range(3)]
    squares = xp.stack(
        [
            1 + m[0][0] + m[1][1] + m[2][2],
            1 + m[0][0] - m[1][1] - m[2][2],
            1 - m[0][0] + m[1][1] - m[2][2],
            1 - m[0][0] - m[1][1] + m[2][2],
        ],
        axis=-1,
    )
    wx, wy, wz = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    xy, xz, yz = m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]
    candidates = [
        xp.stack([squares[..., 0], wx, wy, wz], axis=-1),
        xp.stack([wx, squares[..., 1], xy, xz], axis=-1),
        xp.stack([wy, xy, squares[..., 2], yz], axis=-1),
        xp.stack([wz, xz, yz, squares[..., 3]], axis=-1),
    ]
    best = xp.argmax(squares, axis=-1)
    chosen = candidates[0]
    for index in range(1, 4):
        chosen = xp.where((best == index)[..., None], candidates[index], chosen)
    q = normalize(chosen)
    return xp.where(q[..., :1] < 0.0, -q, q)


def to_rot6d(q: Array) -> Array:
    """Return the first two columns of the rotation matrix ``(..., 6)``: x axis, then y axis.

    A continuous representation, unlike quaternions and Euler angles (Zhou et al. 2019).
    """
    return _contract(q, q, "rot6d")


def heading_angle(q: Array) -> Array:
    """Return the heading ``(...)`` [rad] about the world's z axis of the body's forward (x) axis.

    Where the forward axis is vertical the heading is undefined; then it is that of the turn that
    remains when the tilt is taken away (swing-twist), so that no value is ever not a number.
    """
    xp = array_namespace(q)
    w, x, y, z = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    forward_x, forward_y = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z)
    vertical = forward_x * forward_x + forward_y * forward_y < _TINY
    return xp.where(vertical, 2.0 * xp.atan2(z, w), xp.atan2(forward_y, forward_x))


def from_heading(angle_rad: Array) -> Array:
    """Return the turn ``(..., 4)`` by ``angle_rad (...)`` about the world's z axis."""
    xp = array_namespace(angle_rad)
    half = 0.5 * angle_rad
    zero = xp.zeros_like(half)
    return xp.stack([xp.cos(half), zero, zero, xp.sin(half)], axis=-1)


def heading(q: Array) -> Array:
    """Return the heading frame ``(..., 4)``: the part of ``q`` that turns about the world's z axis."""
    return from_heading(heading_angle(q))


def slerp(a: Array, b: Array, t: Array) -> Array:
    """Interpolate from ``a (..., 4)`` (t = 0) to ``b`` (t = 1) along the shorter arc, ``t (...)``.

    a exp(t log(a^-1 b)): constant angular speed; outside 0..1 it extrapolates (Shoemake 1985).
    """
    difference = multiply(conjugate(a), b)
    return multiply(a, from_rotation_vector(t[..., None] * to_rotation_vector(difference)))


def xyzw_to_wxyz(q: Array) -> Array:
    """Reorder ``(..., 4)`` from x, y, z, w (ROS, scipy) to w, x, y, z."""
    xp = array_namespace(q)
    return xp.concat([q[..., 3:], q[..., :3]], axis=-1)


def wxyz_to_xyzw(q: Array) -> Array:
    """Reorder ``(..., 4)`` from w, x, y, z to x, y, z, w (ROS, scipy)."""
    xp = array_namespace(q)
    return xp.concat([q[..., 1:], q[..., :1]], axis=-1)
