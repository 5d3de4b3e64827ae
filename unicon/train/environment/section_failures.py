"""How often each half second of each clip is failed at, and how much likelier that makes a start before it.

A section of 30 frames counts a visit for each half second that avatars spend in it, and a failure for each
episode that ends there. Its share of failures is

    r = failures / (visits + 1), at most 1,    counted over about its last 20 visits

(the 1 stands for a visit without failure, so that nothing is made of a single one). A start in section i is
weighted by what lies before it as well as by itself:

    weight_i = 1 + (cap - 1) min(1, r_i + 0.7 r_i+1 + 0.49 r_i+2 + 0.343 r_i+3)

The cap keeps clips that cannot be followed at all from taking the place of all others.
"""

from __future__ import annotations

import numpy as np

SECTION_FRAMES = 30
_MEMORY_VISITS = 20.0
_DECAY, _LOOKAHEAD = 0.7, 4


class SectionFailures:
    """Counts for the sections of C clips, one after the other."""

    def __init__(self, lengths: np.ndarray, cap: float) -> None:
        """Begin with no visits; ``lengths (C,)`` are the clips' numbers of frames."""
        self.cap = cap
        counts = -(-lengths // SECTION_FRAMES)
        self.first = np.cumsum(counts) - counts
        """The first section of each clip ``(C,)``."""
        self.clips = np.repeat(np.arange(len(lengths)), counts)
        """The clip of each section ``(S,)``."""
        self._last = (self.first + counts - 1)[self.clips]
        self.failures = np.zeros(len(self.clips))
        """Lately ``(S,)``."""
        self.visits = np.zeros(len(self.clips))
        """Lately ``(S,)``, in half seconds."""

    def section(self, clips: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """Return the sections ``(N,)`` of frames of clips."""
        return self.first[clips] + frames // SECTION_FRAMES

    def add(self, clips: np.ndarray, frames: np.ndarray, failed: np.ndarray, frame_step: int) -> None:
        """Count that avatars arrived at frames ``(N,)`` by a control step, and which of them failed there."""
        sections, count = self.section(clips, frames), len(self.clips)
        self.visits += np.bincount(sections, minlength=count) * (frame_step / SECTION_FRAMES)
        if failed.any():
            self.failures += np.bincount(sections[failed], minlength=count)

    def forget(self) -> None:
        """Let what lies further back than the last 20 visits count no more."""
        kept = _MEMORY_VISITS / np.maximum(self.visits, _MEMORY_VISITS)
        self.visits *= kept
        self.failures *= kept

    def shares(self) -> np.ndarray:
        """Return r of each section ``(S,)``; 0 where nobody has been."""
        return np.minimum(self.failures / (self.visits + 1.0), 1.0)

    def weights(self) -> np.ndarray:
        """Return the weight of a start in each section ``(S,)``, within 1..cap."""
        shares = self.shares()
        ahead = np.arange(len(shares))[:, None] + np.arange(_LOOKAHEAD)  # (S, 4)
        within = ahead <= self._last[:, None]
        seen = np.where(within, shares[np.minimum(ahead, self._last[:, None])], 0.0)
        expected = np.minimum(seen @ _DECAY ** np.arange(_LOOKAHEAD), 1.0)
        return 1.0 + (self.cap - 1.0) * expected
