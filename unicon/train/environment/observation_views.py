"""What the baselines' policies see in place of s_t = [o(X~), o(X), y(X~, X)].

    targets-only   o(X)                     no word of the avatar: open loop
    phase-onehot   o(X~), phase, one-hot    which clip it is, by a 1 among zeros, and no target
    phase-number   o(X~), phase, number     which clip it is, by c / C for the c-th of C clips, and no target

The phase is the share of the clip that is over, 0 to 1. ``ViewedEnvironment`` shows an environment so; the
evaluation (``scoring/baseline_policies.py``) uses the same functions.
"""

from __future__ import annotations

import numpy as np

from unicon.observation import OBSERVATION_SIZE
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.observation_variants import View
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.environment.vector_environment import EnvironmentStep


def view_size(view: View, clips: int) -> int:
    """Return the length of a view of one target frame, other than "whole", among so many clips."""
    sizes = {
        "targets-only": OBSERVATION_SIZE,
        "phase-onehot": OBSERVATION_SIZE + 1 + clips,
        "phase-number": OBSERVATION_SIZE + 2,
    }
    return sizes[view]


def target_of(seen: np.ndarray) -> np.ndarray:
    """Return o(X) ``(..., 197)`` of the target frame in s_t ``(..., 403)``."""
    return seen[..., OBSERVATION_SIZE : 2 * OBSERVATION_SIZE]


def with_clip(seen: np.ndarray, view: View, clips: np.ndarray, count: int, phases: np.ndarray) -> np.ndarray:
    """Return o(X~), phase and clip ``(N, view_size)`` float32.

    Args:
        seen: s_t ``(N, 403)``.
        view: "phase-onehot" or "phase-number".
        clips: the clip's place in the data set ``(N,)``.
        count: C, how many clips there are.
        phases: share of the clip that is over ``(N,)``.
    """
    shown = np.zeros((len(seen), view_size(view, count)), np.float32)
    shown[:, :OBSERVATION_SIZE] = seen[:, :OBSERVATION_SIZE]
    shown[:, OBSERVATION_SIZE] = phases
    if view == "phase-onehot":
        shown[np.arange(len(seen)), OBSERVATION_SIZE + 1 + clips] = 1.0
    else:
        shown[:, OBSERVATION_SIZE + 1] = clips / count
    return shown


def as_seen(environment: TrackingEnvironment) -> TrackingEnvironment | ViewedEnvironment:
    """Return an environment whose observations are the view that its settings ask for."""
    return environment if environment.variant.view == "whole" else ViewedEnvironment(environment)


class ViewedEnvironment:
    """A tracking environment that shows a view; fulfils ``VectorEnvironment``."""

    def __init__(self, environment: TrackingEnvironment) -> None:
        self.environment = environment
        self._view: View = environment.variant.view
        self._last_frames = environment.dataset.lengths - 1

    @property
    def dataset(self) -> Dataset:
        """The clips to follow."""
        return self.environment.dataset

    @property
    def num_envs(self) -> int:
        """N."""
        return self.environment.num_envs

    @property
    def observation_size(self) -> int:
        """Length of the policy's input."""
        return view_size(self._view, len(self._last_frames))

    @property
    def action_size(self) -> int:
        """Numbers in an action."""
        return self.environment.action_size

    def reset(self) -> np.ndarray:
        """Begin a new episode everywhere; return the observations ``(N, O)``."""
        return self._show_present(self.environment.reset())

    def step(self, actions: np.ndarray) -> EnvironmentStep:
        """Advance all by one control step under ``actions (N, 35)``; begin anew where an episode ends."""
        clips = self.environment.clips.copy()
        frames = self.environment.frames + self.environment.config.frame_step
        step = self.environment.step(actions)
        observation = final = self._show_present(step.observation)
        if np.any(step.terminated | step.truncated):
            final = self._show(step.final_observation, clips, frames)
        return step._replace(observation=observation, final_observation=final)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that determines what follows."""
        return self.environment.state()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Go back to a state."""
        self.environment.restore(state)

    def _show_present(self, seen: np.ndarray) -> np.ndarray:
        return self._show(seen, self.environment.clips, self.environment.frames)

    def _show(self, seen: np.ndarray, clips: np.ndarray, frames: np.ndarray) -> np.ndarray:
        if self._view == "targets-only":
            return target_of(seen)
        return with_clip(seen, self._view, clips, len(self._last_frames), frames / self._last_frames[clips])
