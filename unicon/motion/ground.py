"""Puts a motion on the floor: its lowest point at z = 0 while something touches, untouched in flight."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.table import BODIES, ShapeSpec
from unicon.state import CharacterState

CONTACT_M = 0.04
"""A lowest point this close to the floor counts as touching."""
SMOOTHING_FRAMES = 6.0
"""Over how many frames (one sigma, at 60 Hz) the height's correction is smoothed."""
LOW_PERCENTILE = 10.0


def _support(shape: ShapeSpec) -> list[tuple[tuple[float, float, float], float]]:
    """Return points and radii that hold up a shape: ends of a capsule, corners of a box, a ball."""
    if shape.kind == "capsule":
        return [(shape.start, shape.radius), (shape.end, shape.radius)]
    if shape.kind == "ellipsoid":
        return [(shape.start, min(shape.end))]
    (x, y, z), (a, b, c) = shape.start, shape.end
    return [((x + i * a, y + j * b, z + k * c), 0.0) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]


_POINTS = [
    (body, *point)
    for body, spec in enumerate(BODIES)
    for shape in spec.shapes
    if shape.solid
    for point in _support(shape)
]
_BODY = [body for body, _, _ in _POINTS]
_PLACE = np.array([place for _, place, _ in _POINTS])
_RADIUS = np.array([radius for _, _, radius in _POINTS])


def lowest_point(frames: CharacterState) -> np.ndarray:
    """Return the height ``(T,)`` [m] of the lowest point of the body."""
    bodies = forward_kinematics(frames)
    heights = bodies.pos_w[:, _BODY, 2] + np.sum(bodies.rot_w[:, _BODY, 2, :] * _PLACE, axis=-1)
    return (heights - _RADIUS).min(axis=1)


def height_correction(lowest: np.ndarray) -> np.ndarray:
    """Return what to add to the root's height ``(T,)`` [m], given the lowest points ``(T,)``.

    Where something touches, the correction brings the lowest point to the floor; in flight it is
    interpolated, so that the fall stays a fall. What still penetrates is lifted, smoothly.
    """
    offset = np.percentile(lowest, LOW_PERCENTILE)
    above = lowest - offset
    touching = np.flatnonzero(above < CONTACT_M)
    correction = np.interp(np.arange(len(lowest)), touching, above[touching])
    correction = offset + gaussian_filter1d(correction, SMOOTHING_FRAMES, mode="nearest")
    penetration = np.maximum(correction - lowest, 0.0)
    lift = gaussian_filter1d(maximum_filter1d(penetration, 13), 3.0, mode="nearest")
    return lift - correction
