"""Where episodes begin: a clip by the motion balancer and by its failures, then any of its frames alike.

    p(section) = p(clip) * (its share of the clip's frames) * (weight by failures), normalised

p(clip) is the motion balancer's, or, without it, the clip's share of all frames.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon.errors import UniconError
from unicon.motion.catalogue.balancer import MotionBalancer
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.section_failures import SECTION_FRAMES, SectionFailures

_REFRESH_STEPS = 32


class Starts(NamedTuple):
    """Where n episodes begin."""

    clips: np.ndarray
    """Place of the clip in the data set ``(n,)``."""
    frames: np.ndarray
    """Frame of the clip ``(n,)``."""
    mirrored: np.ndarray
    """Whether left and right are exchanged ``(n,)``."""


class EpisodeSampler:
    """Draws starts, and learns from how the episodes end.

    A start always leaves room for one control step within its clip.

    Raises:
        UniconError: when a clip is too short for a control step.
    """

    def __init__(self, dataset: Dataset, config: EnvironmentConfig) -> None:
        self._step, self._mirror_share = config.frame_step, config.mirror_share
        # frames at which a whole control step can begin
        lengths = dataset.lengths - self._step
        if lengths.min() < 1:
            name = dataset.infos[int(lengths.argmin())].name
            raise UniconError(f"the clip {name!r} is too short for one step of control; leave it out")
        self.failures = SectionFailures(lengths, config.failure_cap)
        self._last_start = lengths - 1
        self._section_start = (np.arange(len(self.failures.clips)) - self._of_clip(self.failures.first)) * (
            SECTION_FRAMES
        )
        self._section_size = np.minimum(self._of_clip(lengths) - self._section_start, SECTION_FRAMES)
        clip_share = (
            MotionBalancer(dataset.infos).probabilities if config.balancer else lengths / lengths.sum()
        )
        self._base = self._of_clip(clip_share / lengths) * self._section_size
        self._steps = 0
        self._set_weights(self.failures.weights())

    @property
    def probabilities(self) -> np.ndarray:
        """Of a start in each section ``(S,)``; they sum to 1."""
        return np.diff(self._cumulative, prepend=0.0)

    def draw(self, count: int, rng: np.random.Generator) -> Starts:
        """Draw the starts of ``count`` episodes."""
        uniform = rng.random((3, count))
        sections = np.searchsorted(self._cumulative, uniform[0], side="right")
        within = np.floor(uniform[1] * self._section_size[sections]).astype(np.int64)
        frames = self._section_start[sections] + within
        return Starts(self.failures.clips[sections], frames, uniform[2] < self._mirror_share)

    def add(self, clips: np.ndarray, frames: np.ndarray, failed: np.ndarray) -> None:
        """Take in to where a control step brought all avatars ``(N,)``, and which of them failed."""
        self.failures.add(clips, np.minimum(frames, self._last_start[clips]), failed, self._step)
        self._steps += 1
        if self._steps % _REFRESH_STEPS == 0:
            self.failures.forget()
            self._set_weights(self.failures.weights())

    def state(self) -> dict[str, np.ndarray]:
        """Return all that later draws depend on."""
        counts = {"failures": self.failures.failures.copy(), "visits": self.failures.visits.copy()}
        return {**counts, "weights": self._weights.copy(), "steps": np.array([self._steps])}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Go back to a state.

        Raises:
            ValueError: when it is of other clips.
        """
        self.failures.failures[:], self.failures.visits[:] = state["failures"], state["visits"]
        self._steps = int(state["steps"][0])
        self._set_weights(np.array(state["weights"]))

    def _of_clip(self, values: np.ndarray) -> np.ndarray:
        """Return for each section the value ``(C,)`` of its clip."""
        return values[self.failures.clips]

    def _set_weights(self, weights: np.ndarray) -> None:
        self._weights = weights
        cumulative = np.cumsum(self._base * weights)
        self._cumulative = cumulative / cumulative[-1]
