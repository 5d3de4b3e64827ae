"""Weights as a function of the phase: a closed spline through control points (Holden et al. 2017, 5.2).

K control points stand at the phases 2 pi k / K. At a phase p the curve is a sum of all of them,

    theta(p) = sum_k h(d_k) theta_k,     d_k = K p / 2 pi - k, wrapped to -K/2 .. K/2

with the kernel h of the interpolation. The paper's cyclic Catmull-Rom spline is

    h(d) = 1 - 5/2 |d|^2 + 3/2 |d|^3              for |d| <= 1
         = 2 - 4 |d| + 5/2 |d|^2 - 1/2 |d|^3      for 1 <= |d| <= 2,     else 0

which is its equation 7 with the four points around p gathered by point: h is 1 at its own point and 0 at
all others, and its derivative is continuous. Layers are linear in theta, so that the layer of the curve is
the same sum of the layers of the control points.
"""

from __future__ import annotations

import math
from typing import Any, Literal

from unicon.arrays import array_namespace

Array = Any
Interpolation = Literal["cubic", "linear", "nearest"]
CONTROL_POINTS = 4
"""Of a network that is trained here, and in the paper."""


def control_weights(
    phase: Array, count: int = CONTROL_POINTS, interpolation: Interpolation = "cubic"
) -> Array:
    """Return how much each control point counts at the phases.

    Args:
        phase: ``(...)`` [rad]; any value, as the curve is closed.
        count: K, 4 or more for "cubic".
        interpolation: "cubic" as above, "linear" between the two points beside, or the "nearest" one.

    Returns:
        ``(..., K)``; they sum to 1.
    """
    xp = array_namespace(phase)
    points = xp.arange(count, dtype=phase.dtype)
    turns = phase[..., None] * (count / (2.0 * math.pi)) - points
    half = 0.5 * count
    distance = xp.remainder(turns + half, xp.asarray(float(count), dtype=phase.dtype)) - half
    if interpolation == "nearest":
        return xp.astype((distance >= -0.5) & (distance < 0.5), phase.dtype)
    distance = xp.abs(distance)
    if interpolation == "linear":
        return xp.clip(1.0 - distance, 0.0, 1.0)
    return _catmull_rom(distance, xp)


def _catmull_rom(d: Array, xp: Any) -> Array:
    """Return h of distances d >= 0."""
    near = 1.0 + d * d * (1.5 * d - 2.5)
    far = 2.0 + d * (d * (2.5 - 0.5 * d) - 4.0)
    return xp.where(d <= 1.0, near, xp.where(d < 2.0, far, xp.zeros_like(d)))
