"""Draws batches of frames with the frames that follow them out of a clip library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from unicon.motion.store.library import ClipLibrary, as_states
from unicon.motion.store.library_index import POSE_WIDTH, WIDTH
from unicon.state import CharacterState


@dataclass(frozen=True)
class FrameBatch:
    """N places in clips, and K states seen from each."""

    rows: np.ndarray
    """The clip of each: its place in the library's ``infos`` ``(N,)``."""
    frames: np.ndarray
    """The frame in that clip ``(N,)``."""
    states: CharacterState
    """Batch ``(N, K)``, float32: the states at ``frames`` plus each offset."""
    held: np.ndarray
    """Where an offset points past the clip's end ``(N, K)``."""


class FrameSampler:
    """Draws start frames: first a clip by its probability, then one of its frames with equal chances.

    The last frame of a clip is never a start, so that there is always one to follow it. Past a clip's end
    its last pose is held with zero velocities, as the executor does when its targets stop.
    """

    def __init__(
        self,
        library: ClipLibrary,
        rows: Sequence[int] | np.ndarray | None = None,
        probabilities: np.ndarray | None = None,
        offsets: Sequence[int] = (0, 1),
    ) -> None:
        """Choose from the clips ``rows (C,)`` (all where None) with ``probabilities (C,)``.

        Without probabilities every frame is equally likely. ``offsets (K,)``, none negative: which frames
        to return, counted from the start.

        Raises:
            ValueError: when there are no clips, or the probabilities do not fit them.
        """
        self.library = library
        self.rows = np.arange(len(library)) if rows is None else np.asarray(rows, dtype=np.int64)
        self.offsets = np.asarray(offsets, dtype=np.int64)
        if len(self.rows) == 0 or self.offsets.min() < 0:
            raise ValueError("needs at least one clip, and offsets that are not negative")
        weights = library.lengths[self.rows] - 1.0 if probabilities is None else np.asarray(probabilities)
        if weights.shape != self.rows.shape or np.any(weights < 0) or weights.sum() <= 0:
            raise ValueError(f"needs {len(self.rows)} probabilities, none negative and not all zero")
        cumulative = np.cumsum(weights, dtype=np.float64)
        self._cumulative = cumulative / cumulative[-1]

    def sample(self, count: int, rng: np.random.Generator) -> FrameBatch:
        """Draw ``count`` start frames and gather their states."""
        chosen = np.searchsorted(self._cumulative, rng.random(count), side="right")
        rows = self.rows[chosen]
        frames = np.floor(rng.random(count) * (self.library.lengths[rows] - 1)).astype(np.int64)
        return self.gather(rows, frames)

    def gather(self, rows: np.ndarray, frames: np.ndarray) -> FrameBatch:
        """Return the states seen from given clips and frames ``(N,)``."""
        first = self.library.first_frames[rows]
        last = first + self.library.lengths[rows] - 1
        wanted = (first + frames)[:, None] + self.offsets
        held = wanted > last[:, None]
        indices = np.minimum(wanted, last[:, None]).ravel()
        # Mode "clip" saves a check of the indices, which are within bounds already.
        values = np.take(self.library.array, indices, axis=0, mode="clip")
        values[np.flatnonzero(held), POSE_WIDTH:] = 0.0
        return FrameBatch(rows, frames, as_states(values.reshape(*wanted.shape, WIDTH)), held)
