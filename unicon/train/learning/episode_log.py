"""How long episodes last and how they end, for the log."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon.reward import RewardTerms
from unicon.train.environment.vector_environment import EnvironmentStep


class EpisodeSummary(NamedTuple):
    """Means over the steps of an iteration, and over the episodes that ended in it."""

    reward: float
    terms: RewardTerms
    """The five terms, each a float."""
    length: float
    """Control steps of an episode; that of the iteration before where none ended."""
    survival: float
    """Share of the episodes that did not break the constraint."""


class EpisodeLog:
    """Counts the steps of N environments."""

    def __init__(self, num_envs: int) -> None:
        self.lengths = np.zeros(num_envs, np.int64)
        """Steps of the running episodes ``(N,)``."""
        self._length, self._survival = 0.0, 0.0
        self.begin()

    def begin(self) -> None:
        """Begin an iteration."""
        self._steps, self._ended, self._ended_steps, self._broken = 0, 0, 0, 0
        self._sums = np.zeros(1 + len(RewardTerms._fields))

    def add(self, step: EnvironmentStep) -> None:
        """Count a step of all environments."""
        self._steps += 1
        self._sums += [np.mean(step.reward), *(np.mean(term) for term in step.terms)]
        self.lengths += 1
        ended = step.terminated | step.truncated
        count = int(np.count_nonzero(ended))
        if count:
            self._ended += count
            self._ended_steps += int(self.lengths[ended].sum())
            self._broken += int(np.count_nonzero(step.terminated))
            self.lengths[ended] = 0

    def summary(self) -> EpisodeSummary:
        """Return the means since ``begin``."""
        if self._ended:
            self._length = self._ended_steps / self._ended
            self._survival = 1.0 - self._broken / self._ended
        reward, *terms = (self._sums / max(self._steps, 1)).tolist()
        return EpisodeSummary(reward, RewardTerms(*terms), self._length, self._survival)
