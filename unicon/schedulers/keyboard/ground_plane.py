"""Vectors along the ground."""

from __future__ import annotations

import numpy as np


def rotated(vectors: np.ndarray, angle: float) -> np.ndarray:
    """Return vectors ``(..., 2)`` turned counter-clockwise."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
