"""Directions and the frames that they span."""

from __future__ import annotations

import numpy as np

from unicon import rotations

_TINY = 1e-12


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return the directions ``(..., 3)`` of vectors; zero stays zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), _TINY)


def across(vectors: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return the parts ``(..., 3)`` of vectors that are perpendicular to unit directions."""
    return vectors - np.sum(vectors * directions, axis=-1, keepdims=True) * directions


def frame(up: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Return the turns ``(..., 4)`` with z along ``up`` and y as near to ``left`` as can be."""
    z = unit(up)
    y = unit(across(left, z))
    return rotations.from_matrix(np.stack([rotations.cross(y, z), y, z], axis=-1))


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles ``(...)`` [rad] between vectors ``(..., 3)``, exact for small ones too."""
    sine = np.linalg.norm(rotations.cross(a, b), axis=-1)
    return np.arctan2(sine, np.sum(a * b, axis=-1))
