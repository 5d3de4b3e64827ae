"""The avatars' own last states, as the observation variant stack-k shows them."""

from __future__ import annotations

import numpy as np

from unicon.observation import OBSERVATION_SIZE


class StateHistory:
    """What N avatars saw of themselves, o(X~), in their last ``count`` control steps; 0: nothing."""

    def __init__(self, num_envs: int, count: int) -> None:
        # [:, 0] is the present, the others follow into the past
        self._states = np.zeros((num_envs, count + 1, OBSERVATION_SIZE), np.float32)
        self._count = count

    def follow(self, seen: np.ndarray) -> np.ndarray:
        """Take in what all see now, s_t ``(N, O)``; return it with what was before."""
        if not self._count:
            return seen
        self._states[:, 1:] = self._states[:, :-1].copy()
        self._states[:, 0] = seen[:, :OBSERVATION_SIZE]
        return self._append(seen, slice(None))

    def begin(self, seen: np.ndarray, envs: np.ndarray) -> np.ndarray:
        """Begin anew for avatars ``envs (n,)``, whose first ``seen (n, O)`` stands for the past."""
        if not self._count:
            return seen
        self._states[envs] = seen[:, None, :OBSERVATION_SIZE]
        return self._append(seen, envs)

    def state(self) -> dict[str, np.ndarray]:
        """Return what later steps depend on."""
        return {"states": self._states.copy()} if self._count else {}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Go back to a state."""
        if self._count:
            self._states[:] = state["states"]

    def _append(self, seen: np.ndarray, envs: np.ndarray | slice) -> np.ndarray:
        past = self._states[envs, 1:]
        return np.concatenate([seen, past.reshape(len(past), -1)], axis=1)
