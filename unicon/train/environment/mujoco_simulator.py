"""The reference simulator: MuJoCo's own batch on threads, with exactly the executor's model, in float64."""

from __future__ import annotations

import mujoco
import numpy as np
from mujoco.batch import Batch, SimulationError

from unicon import rotations
from unicon.control import Control, ServoControl
from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import MOTOR_GROUP, SERVO_GROUP, compile_model
from unicon.observation import policy_input
from unicon.reward import TrackingErrors, tracking_errors
from unicon.simulation import SimulationConfig
from unicon.state import CharacterState
from unicon.target_frames import FRAME_SIZE, pack, unpack

_SERVO_LEAD_S = HUMANOID.damping / HUMANOID.stiffness
_JOINTS = len(HUMANOID.joint_names)


class MujocoSimulator:
    """N avatars in MuJoCo, at first in the rest pose; a ``Simulator`` (simulators.py)."""

    def __init__(self, num_envs: int, substeps: int, timestep_s: float, threads: int) -> None:
        """Make room; a control is held for ``substeps`` physics steps of ``timestep_s`` [s]."""
        self._substeps, self._max_speed = substeps, SimulationConfig().max_speed
        self._batches = {
            servo: Batch(_model(servo, timestep_s), num_envs, nthread=threads) for servo in (False, True)
        }
        self._rows = np.empty((num_envs, FRAME_SIZE))
        self._rows[:] = pack(HUMANOID.rest_state())

    @property
    def rows(self) -> np.ndarray:
        """The states ``(N, 83)`` float64."""
        return self._rows

    def put(self, rows: np.ndarray, envs: np.ndarray) -> None:
        """Put some avatars into states; their quaternions are brought to unit length."""
        rows = np.array(rows, np.float64)
        rows[:, 3:7] = rotations.normalize(rows[:, 3:7])
        self._rows[envs] = rows

    def restore(self, rows: np.ndarray) -> None:
        """Go back to states."""
        self._rows[:] = rows

    def step(self, control: Control) -> np.ndarray:
        """Advance all; return which are sound."""
        batch = self._batches[isinstance(control, ServoControl)]
        batch.qpos[:], batch.qvel[:] = unpack(self._rows).to_mujoco()
        if isinstance(control, ServoControl):
            batch.ctrl[:, _JOINTS:] = control.joint_pos + _SERVO_LEAD_S * control.joint_vel
        else:
            batch.ctrl[:, :_JOINTS] = control.torque
        try:
            batch.step(nstep=self._substeps)
        except SimulationError as error:
            batch.qvel[error.ids] = np.nan
        self._rows[:] = pack(CharacterState.from_mujoco(batch.qpos, batch.qvel))
        with np.errstate(invalid="ignore"):
            slow = np.abs(batch.qvel).max(axis=1) <= self._max_speed
        return slow & np.isfinite(batch.qpos).all(axis=1)

    def observe(self, targets: np.ndarray, envs: np.ndarray | None = None) -> np.ndarray:
        """Return s_t of all or some."""
        rows = self._rows if envs is None else self._rows[envs]
        return policy_input(unpack(rows), unpack(targets.astype(np.float64))).astype(np.float32)

    def errors(self, target: np.ndarray) -> TrackingErrors:
        """Return the squared errors."""
        errors = tracking_errors(unpack(self._rows), unpack(target.astype(np.float64)))
        return TrackingErrors(*(error.astype(np.float32) for error in errors))


def _model(servo: bool, timestep_s: float) -> mujoco.MjModel:
    model = compile_model()
    model.opt.disableactuator = 1 << (MOTOR_GROUP if servo else SERVO_GROUP)
    model.opt.timestep = timestep_s
    return model
