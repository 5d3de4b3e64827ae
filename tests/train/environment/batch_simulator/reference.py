"""MuJoCo beside the batch simulator: random states and controls, the same step in both."""

from __future__ import annotations

import mujoco
import numpy as np

from unicon.control import Control, ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import MOTOR_GROUP, SERVO_GROUP, compile_model
from unicon.state import CharacterState
from unicon.train.environment.batch_simulator.simulator import BatchSimulator, BatchSimulatorConfig

JOINTS = len(HUMANOID.joint_names)
SERVO_LEAD_S = HUMANOID.damping / HUMANOID.stiffness


def random_states(
    count: int, seed: int = 0, height_m: float = 5.0, speed: float = 3.0, beyond: float = -0.05
) -> CharacterState:
    """Any rotation and angles, which lie ``beyond`` (a share of the range) the joints' limits at most."""
    rng = np.random.default_rng(seed)
    quat = rng.standard_normal((count, 4))
    share = rng.uniform(-beyond, 1.0 + beyond, (count, JOINTS))
    span = HUMANOID.joint_upper - HUMANOID.joint_lower
    place = rng.standard_normal((count, 2))
    state = CharacterState(
        root_pos_w=np.column_stack([place, np.full(count, height_m)]),
        root_quat_w=quat / np.linalg.norm(quat, axis=1, keepdims=True),
        root_lin_vel_w=speed * rng.standard_normal((count, 3)),
        root_ang_vel_w=speed * rng.standard_normal((count, 3)),
        joint_pos=HUMANOID.joint_lower + span * share,
        joint_vel=speed * rng.standard_normal((count, JOINTS)),
    )
    return rounded(state)


def rounded(state: CharacterState) -> CharacterState:
    """What float32 leaves of a state, as float64: both simulators then start from the same numbers."""
    return CharacterState(*(np.asarray(v, np.float32).astype(float) for v in vars(state).values()))


def random_servos(state: CharacterState, seed: int = 0, size: float = 0.2) -> ServoControl:
    rng = np.random.default_rng(seed)
    shape = state.joint_pos.shape
    return ServoControl(state.joint_pos + size * rng.standard_normal(shape), rng.standard_normal(shape))


def random_torques(count: int, seed: int = 0) -> TorqueControl:
    rng = np.random.default_rng(seed)
    return TorqueControl(HUMANOID.effort * rng.uniform(-1.2, 1.2, (count, JOINTS)))


class MujocoReference:
    """MuJoCo, one environment after the other."""

    def __init__(self, timestep_s: float = 1.0 / 240.0) -> None:
        self.model = compile_model()
        self.model.opt.timestep = timestep_s
        self.data = mujoco.MjData(self.model)

    def step(self, state: CharacterState, control: Control, substeps: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``qpos`` and ``qvel`` of states ``(N)`` after some substeps."""
        results = []
        for qpos, qvel, values in zip(*state.to_mujoco(), self.values(control), strict=True):
            self.put(qpos, qvel)
            self.data.ctrl[:] = values
            for _ in range(substeps):
                mujoco.mj_step(self.model, self.data)
            results.append((self.data.qpos.copy(), self.data.qvel.copy()))
        qpos, qvel = zip(*results, strict=True)
        return np.array(qpos), np.array(qvel)

    def put(self, qpos: np.ndarray, qvel: np.ndarray) -> None:
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:], self.data.qvel[:] = qpos, qvel

    def values(self, control: Control) -> np.ndarray:
        """Choose the actuators, and return their controls ``(N, 70)``."""
        if isinstance(control, ServoControl):
            self.model.opt.disableactuator = 1 << MOTOR_GROUP
            aims = control.joint_pos + SERVO_LEAD_S * control.joint_vel
            return np.concatenate([np.zeros_like(aims), aims], axis=1)
        self.model.opt.disableactuator = 1 << SERVO_GROUP
        return np.concatenate([control.torque, np.zeros_like(control.torque)], axis=1)


def simulate(state: CharacterState, **config: object) -> BatchSimulator:
    """Return a batch simulator in the given states, on one thread."""
    options = BatchSimulatorConfig(**{"threads": 1, **config})  # type: ignore[arg-type]
    simulator = BatchSimulator(len(state.root_pos_w), options)
    simulator.set_state(state)
    return simulator


def as_mujoco(simulator: BatchSimulator) -> tuple[np.ndarray, np.ndarray]:
    return rounded(simulator.state()).to_mujoco()
