"""Reads the frames that avatars follow, out of the clips of a data set and mirrored where asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from unicon.motion.store.frame_sampler import FrameSampler
from unicon.target_frames import pack
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.mirroring import mirror_rows


class ReferenceFrames:
    """The frames at fixed offsets from any frame; past a clip's end its last pose is held at rest."""

    def __init__(self, dataset: Dataset, offsets: Sequence[int]) -> None:
        """Read at ``offsets (K,)``, counted from the frame that is asked for [1/60 s]; none negative."""
        self._rows = dataset.rows
        self._sampler = FrameSampler(dataset.library, dataset.rows, offsets=offsets)

    def read(self, clips: np.ndarray, frames: np.ndarray, mirrored: np.ndarray) -> np.ndarray:
        """Return packed frames ``(n, K, 83)`` float32 of places ``(n,)`` in the data set's clips."""
        rows = pack(self._sampler.gather(self._rows[clips], frames).states)
        if mirrored.any():
            rows[mirrored] = mirror_rows(rows[mirrored])
        return rows
