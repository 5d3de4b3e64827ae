"""Left and right exchanged, for packed frames: a humanoid that is symmetric doubles its data for nothing.

The reflection of ``HUMANOID.mirror`` only moves numbers and changes signs, so that on rows of
``unicon.target_frames.pack`` it is one reordering and one product.
"""

from __future__ import annotations

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.target_frames import FRAME_SIZE, pack, unpack


def _find_reflection() -> tuple[np.ndarray, np.ndarray]:
    """Return where each number of a mirrored row comes from ``(83,)``, and its sign ``(83,)``."""
    images = pack(HUMANOID.mirror(unpack(np.eye(FRAME_SIZE))))  # row i: where the i-th number goes
    order = np.abs(images).argmax(axis=0)
    return order, images[order, np.arange(FRAME_SIZE)].astype(np.float32)


MIRROR_ORDER, MIRROR_SIGN = _find_reflection()


def mirror_rows(rows: np.ndarray) -> np.ndarray:
    """Return rows ``(..., 83)`` with left and right exchanged."""
    return rows[..., MIRROR_ORDER] * MIRROR_SIGN
