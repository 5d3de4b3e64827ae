"""What the learner knows of the world: many environments that step together. The whole contract.

N environments, O observations, 35 actions; float32 numpy arrays, one row an environment. An environment
that ends is reset within the same step: ``observation`` is then the first of its next episode, and
``final_observation`` is where the last one ended.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from unicon.reward import RewardTerms


class EnvironmentStep(NamedTuple):
    """What a step of all environments brought."""

    observation: np.ndarray
    """What to act on next ``(N, O)``."""
    reward: np.ndarray
    """``(N,)``, within 0..1."""
    terminated: np.ndarray
    """``(N,)`` bool: the constraint was broken; nothing more would have come."""
    truncated: np.ndarray
    """``(N,)`` bool: clip or time were over; the value of ``final_observation`` stands for the rest."""
    final_observation: np.ndarray
    """``(N, O)``; rows count only where an episode ended."""
    terms: RewardTerms
    """The five terms, each ``(N,)``: for the log."""


class VectorEnvironment(Protocol):
    """N environments."""

    @property
    def num_envs(self) -> int:
        """N."""
        ...

    @property
    def observation_size(self) -> int:
        """O."""
        ...

    @property
    def action_size(self) -> int:
        """Numbers in an action, each in shares of a joint's largest torque."""
        ...

    def reset(self) -> np.ndarray:
        """Begin a new episode everywhere; return the observations ``(N, O)``."""
        ...

    def step(self, actions: np.ndarray) -> EnvironmentStep:
        """Advance all environments by one control step under ``actions (N, 35)``."""
        ...

    def state(self) -> dict[str, np.ndarray]:
        """Return all that determines what follows, random generators included, as named arrays."""
        ...

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Go back to a state, to the bit."""
        ...
