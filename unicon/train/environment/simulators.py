"""What the tracking environment knows of physics. The whole contract, and who fulfils it.

N avatars that know nothing of each other, each in a state of 83 numbers in the layout of
``unicon.target_frames.pack``. States and controls alone determine what follows, to the bit, on any number
of threads. Which avatars a call concerns is said by their indices.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Protocol

import numpy as np

from unicon.control import Control
from unicon.motion.clip_index import RATE_HZ
from unicon.reward import TrackingErrors
from unicon.train.environment.action_modes import ticks_held
from unicon.train.environment.batch_simulator.build import NoCompilerError
from unicon.train.environment.batch_simulator.simulator import BatchSimulator, BatchSimulatorConfig
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.mujoco_simulator import MujocoSimulator


class Simulator(Protocol):
    """N avatars."""

    @property
    def rows(self) -> np.ndarray:
        """The states ``(N, 83)``, not to be written to."""
        ...

    def put(self, rows: np.ndarray, envs: np.ndarray) -> None:
        """Put the avatars ``envs (n,)`` into states ``(n, 83)``."""
        ...

    def restore(self, rows: np.ndarray) -> None:
        """Go back to states ``(N, 83)`` that ``rows`` gave, to the bit."""
        ...

    def step(self, control: Control) -> np.ndarray:
        """Advance all under controls ``(N, 35)``, held for as long as the simulator was made for.

        Returns:
            Which are sound ``(N,)``: finite, and not too fast. What is not has to be put into a new state.
        """
        ...

    def observe(self, targets: np.ndarray, envs: np.ndarray | None = None) -> np.ndarray:
        """Return s_t ``(n, 197 + 206 tau)`` float32 of all or some avatars.

        ``targets (n, tau, 83)`` are theirs (``unicon.observation.policy_input``).
        """
        ...

    def errors(self, target: np.ndarray) -> TrackingErrors:
        """Return the five squared errors ``(N,)`` float32 to ``target (N, 83)`` (``unicon.reward``)."""
        ...


def make_simulator(config: EnvironmentConfig, say: Callable[[str], None] | None = None) -> Simulator:
    """Return the simulator that a configuration asks for.

    Where the batch simulator cannot be compiled it is MuJoCo; ``say`` is given the sentence that says so,
    which otherwise goes to stderr.
    """
    threads = config.threads or len(os.sched_getaffinity(0))
    substeps = config.substeps * ticks_held(config.action, config.control_hz)
    timestep_s = 1.0 / (RATE_HZ * config.substeps)
    if config.simulator == "batch":
        settings = BatchSimulatorConfig(
            substeps=substeps,
            timestep_s=timestep_s,
            constraint_solves=config.constraint_solves,
            threads=threads,
        )
        try:
            return CompiledSimulator(config.num_envs, settings)
        except NoCompilerError as error:
            (say or _say)(f"{error}: going on with the mujoco simulator")
    return MujocoSimulator(config.num_envs, substeps, timestep_s, threads)


class CompiledSimulator:
    """``BatchSimulator`` under the contract."""

    def __init__(self, num_envs: int, config: BatchSimulatorConfig) -> None:
        self._simulator = BatchSimulator(num_envs, config)

    @property
    def rows(self) -> np.ndarray:
        """The states ``(N, 83)`` float32."""
        return self._simulator.rows

    def put(self, rows: np.ndarray, envs: np.ndarray) -> None:
        """Put some avatars into states."""
        self._simulator.rows[envs] = rows

    def restore(self, rows: np.ndarray) -> None:
        """Go back to states."""
        self._simulator.rows[:] = rows

    def step(self, control: Control) -> np.ndarray:
        """Advance all; return which are sound."""
        return self._simulator.step(control)

    def observe(self, targets: np.ndarray, envs: np.ndarray | None = None) -> np.ndarray:
        """Return s_t of all or some."""
        if envs is None:
            return self._simulator.observe(targets)
        some = BatchSimulator(len(envs), self._simulator.config)
        some.rows[:] = self._simulator.rows[envs]
        return some.observe(targets)

    def errors(self, target: np.ndarray) -> TrackingErrors:
        """Return the squared errors."""
        return self._simulator.errors(target)


def _say(sentence: str) -> None:
    print(sentence, file=sys.stderr)
