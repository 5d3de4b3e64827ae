"""Many humanoids at once: the same physics as ``unicon.simulation`` in the compiled kernel, in float32.

The states lie in one array of rows, which the kernel reads and writes in place. A step depends on the
states and the controls alone: not on what went before, on the neighbours or on the number of threads, to
the bit. MuJoCo judges every policy; this is for training.
"""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from unicon.control import Control, ServoControl
from unicon.humanoid import HUMANOID
from unicon.observation import policy_input_size
from unicon.reward import TrackingErrors
from unicon.state import CharacterState
from unicon.target_frames import FRAME_SIZE, pack, unpack
from unicon.train.environment.batch_simulator.kernel import StepOptions, load_kernel

_SERVO_LEAD_S = (HUMANOID.damping / HUMANOID.stiffness).astype(np.float32)


@dataclass(frozen=True)
class BatchSimulatorConfig:
    """Rates and physics; the defaults are those of ``unicon.simulation``."""

    substeps: int = 4
    """Physics steps a tick: 4 at 60 Hz control, 8 at 30 Hz."""
    timestep_s: float = 1.0 / 240.0
    """Length of a physics step."""
    constraint_solves: int = 6
    """At most as often a physics step is solved for which contacts and joint stops push. With 6 nearly every
    step is MuJoCo's; 2 or 3 are coarser and faster where many limbs lie on the floor."""
    gravity_m_s2: float = 9.81
    """Downwards."""
    damping_scale: float = 1.0
    """Times the passive damping of the hinges; 0 leaves a system that keeps its energy."""
    max_speed: float = 500.0
    """A velocity above it [m/s or rad/s] counts as a fault, as not finite does."""
    threads: int = len(os.sched_getaffinity(0))
    """How many threads share the environments."""


class BatchSimulator:
    """N humanoids that know nothing of each other, at first in the rest pose."""

    def __init__(
        self,
        num_envs: int,
        config: BatchSimulatorConfig = BatchSimulatorConfig(),  # noqa: B008 - frozen
    ) -> None:
        """Compile the kernel if need be.

        Raises:
            NoCompilerError: when this machine cannot; the ``mujoco`` simulator does the same, slowly.
        """
        self.config = config
        self.num_envs = num_envs
        self._kernel = load_kernel()
        self._rows = np.empty((num_envs, FRAME_SIZE), np.float32)
        self._rows[:] = pack(HUMANOID.rest_state())

    @property
    def rows(self) -> np.ndarray:
        """The states themselves ``(N, 83)`` float32, in the layout of ``unicon.target_frames.pack``."""
        return self._rows

    def state(self) -> CharacterState:
        """Return the states ``(N)`` as float32 views, which every step and reset changes."""
        return unpack(self._rows)

    def set_state(self, state: CharacterState, envs: Any = slice(None)) -> None:
        """Put environments, chosen by a slice, mask or indices, into states ``(n)``."""
        self._rows[envs] = pack(state)

    def step(self, control: Control) -> np.ndarray:
        """Advance all by one tick under controls ``(N, 35)``.

        Returns:
            Which environments are sound ``(N)``. One that is not stays so until it is given a new state.
        """
        config, servo = self.config, isinstance(control, ServoControl)
        if isinstance(control, ServoControl):
            values = control.joint_pos + _SERVO_LEAD_S * control.joint_vel
        else:
            values = control.torque
        values = self._rows_of(values, len(HUMANOID.joint_names))
        options = StepOptions(
            substeps=config.substeps,
            solves=config.constraint_solves,
            servo=servo,
            timestep=config.timestep_s,
            gravity=config.gravity_m_s2,
            damping_scale=config.damping_scale,
            max_speed=config.max_speed,
        )
        sound = np.empty(self.num_envs, np.bool_)
        self._kernel.unicon_step(
            self.num_envs, config.threads, ctypes.byref(options), self._rows, values, sound
        )
        return sound

    def observe(self, targets: CharacterState | np.ndarray) -> np.ndarray:
        """Return s_t ``(N, 197 + 206 tau)`` (``unicon.observation.policy_input``) as float32.

        Args:
            targets: states ``(N, tau)``, or their rows ``(N, tau, 83)``; without any, tau is 0.
        """
        rows = targets if isinstance(targets, np.ndarray) else pack(targets)
        tau = rows.shape[1]
        rows = self._rows_of(rows, tau, FRAME_SIZE)
        seen = np.empty((self.num_envs, policy_input_size(tau)), np.float32)
        self._kernel.unicon_observe(self.num_envs, self.config.threads, tau, self._rows, rows, seen)
        return seen

    def errors(self, target: CharacterState | np.ndarray) -> TrackingErrors:
        """Return the five squared errors (``unicon.reward.tracking_errors``), each ``(N)`` float32.

        Args:
            target: states ``(N)``, or their rows ``(N, 83)``.
        """
        rows = self._rows_of(target if isinstance(target, np.ndarray) else pack(target), FRAME_SIZE)
        errors = np.empty((self.num_envs, len(TrackingErrors._fields)), np.float32)
        self._kernel.unicon_errors(self.num_envs, self.config.threads, self._rows, rows, errors)
        return TrackingErrors(*errors.T)

    def _rows_of(self, values: np.ndarray, *shape: int) -> np.ndarray:
        """Return the values as contiguous float32, copied only where they are not.

        Raises:
            ValueError: when they have the wrong shape.
        """
        rows = np.ascontiguousarray(values, np.float32)
        if rows.shape != (self.num_envs, *shape):
            raise ValueError(f"expected an array of shape {(self.num_envs, *shape)}, got {rows.shape}")
        return rows
