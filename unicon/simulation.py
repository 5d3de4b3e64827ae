"""One avatar in MuJoCo: four physics steps a tick, contacts, projectiles, and no way for NaN to get out.

Positions and velocities alone determine what follows: the same state and the same controls give the same
bits. Balls live in a second model that is used only from a throw until the balls' time is over, so that
an avatar at which nothing was thrown does not depend on them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np

from unicon.control import Control, ServoControl
from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import MOTOR_GROUP, SERVO_GROUP, compile_model
from unicon.projectile import Projectile, aim
from unicon.state import CharacterState

CONTROL_HZ = 60
SUBSTEPS = 4
QPOS_SIZE, QVEL_SIZE = 42, 41

_SERVO_LEAD_S = HUMANOID.damping / HUMANOID.stiffness


@dataclass(frozen=True)
class SimulationConfig:
    """Limits of the simulation."""

    balls: int = 4
    """How many balls can be in the air; one more takes the oldest one's place."""
    ball_lifetime_s: float = 5.0
    """How long a ball stays after its throw."""
    max_speed: float = 500.0
    """A velocity above it [m/s or rad/s] counts as a fault, as not finite does."""


class StepResult(NamedTuple):
    """What a tick's physics did."""

    torque: np.ndarray
    """Joint torques ``(35,)`` [N m], mean over the physics steps, passive damping not included."""
    contact_force: np.ndarray
    """Normal force on each body ``(20,)`` [N] at the end of the tick."""
    finite: bool
    """False when the physics failed and the state before the tick was restored."""


@dataclass(frozen=True)
class Snapshot:
    """Everything that determines what follows."""

    qpos: np.ndarray
    qvel: np.ndarray
    ball_ages: tuple[float | None, ...]
    """Age of each ball [s], None where it is parked."""
    balls: tuple[tuple[float, float], ...]
    """Mass [kg] and radius [m] of each ball."""


class Simulation:
    """One avatar. It starts in the rest pose."""

    def __init__(self, config: SimulationConfig = SimulationConfig()) -> None:  # noqa: B008 - frozen
        self.config = config
        self._model = compile_model()
        self._data = mujoco.MjData(self._model)
        self._bodies = self._geom_bodies()
        self._plain: tuple[mujoco.MjModel, mujoco.MjData] = (self._model, self._data)
        self._with_balls: tuple[mujoco.MjModel, mujoco.MjData] | None = None
        self._ball_ages: list[float | None] = [None] * config.balls
        self.reset(HUMANOID.rest_state())

    @property
    def model(self) -> mujoco.MjModel:
        """The model in use."""
        return self._model

    @property
    def state(self) -> CharacterState:
        """The avatar's present state, in arrays of its own."""
        data = self._data
        return CharacterState.from_mujoco(data.qpos[:QPOS_SIZE].copy(), data.qvel[:QVEL_SIZE].copy())

    @property
    def ball_positions_w(self) -> np.ndarray:
        """Positions ``(n, 3)`` [m] of the balls that are in the world."""
        flying = [i for i, age in enumerate(self._ball_ages) if age is not None]
        start = [QPOS_SIZE + 7 * i for i in flying]
        return np.array([self._data.qpos[s : s + 3] for s in start]).reshape(-1, 3)

    def reset(self, state: CharacterState) -> None:
        """Put the avatar into a state; all balls are gone."""
        self._use(*self._plain)
        self._ball_ages = [None] * self.config.balls
        qpos, qvel = state.to_mujoco()
        self._write(qpos, qvel)

    def step(self, control: Control) -> StepResult:
        """Advance by one tick.

        Raises:
            ValueError: when the control has the wrong shape or is not finite.
        """
        before = self.snapshot()
        self._set_control(control)
        torque = np.zeros(len(HUMANOID.joint_names))
        for _ in range(SUBSTEPS):
            mujoco.mj_step(self._model, self._data)
            torque += self._data.qfrc_actuator[6:QVEL_SIZE]
        if not self._is_sound():
            self.restore(before)
            return StepResult(0.0 * HUMANOID.effort, np.zeros(len(HUMANOID.body_names)), False)
        self._age_balls()
        return StepResult(torque / SUBSTEPS, self._contact_force(), True)

    def throw(self, projectile: Projectile) -> None:
        """Throw a ball at the avatar as it stands now."""
        launch = aim(projectile, self.state)
        self._bring_balls()
        index = self._next_ball()
        self._shape_ball(index, projectile.mass_kg, projectile.radius_m)
        qpos, qvel = QPOS_SIZE + 7 * index, QVEL_SIZE + 6 * index
        self._data.qpos[qpos : qpos + 7] = (*launch.pos_w, 1.0, 0.0, 0.0, 0.0)
        self._data.qvel[qvel : qvel + 6] = (*launch.vel_w, 0.0, 0.0, 0.0)
        self._ball_ages[index] = 0.0

    def snapshot(self) -> Snapshot:
        """Return everything that determines what follows."""
        balls = self._balls() if self._flies_balls() else ()
        return Snapshot(self._data.qpos.copy(), self._data.qvel.copy(), tuple(self._ball_ages), tuple(balls))

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        self._ball_ages = list(snapshot.ball_ages)
        if snapshot.balls:
            self._bring_balls()
            for index, (mass_kg, radius_m) in enumerate(snapshot.balls):
                self._shape_ball(index, mass_kg, radius_m)
        else:
            self._use(*self._plain)
        self._write(snapshot.qpos, snapshot.qvel)

    def _write(self, qpos: np.ndarray, qvel: np.ndarray) -> None:
        mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[:], self._data.qvel[:] = qpos, qvel

    def _set_control(self, control: Control) -> None:
        count = len(HUMANOID.joint_names)
        if isinstance(control, ServoControl):
            aimed = control.joint_pos + _SERVO_LEAD_S * control.joint_vel
            self._model.opt.disableactuator = 1 << MOTOR_GROUP
            values, part = aimed, slice(count, 2 * count)
        else:
            self._model.opt.disableactuator = 1 << SERVO_GROUP
            values, part = control.torque, slice(0, count)
        if np.shape(values) != (count,) or not np.isfinite(values).all():
            raise ValueError(f"a control needs {count} finite values, got {values!r}")
        self._data.ctrl[part] = values

    def _is_sound(self) -> bool:
        data = self._data
        speed = np.abs(data.qvel).max()
        return bool(np.isfinite(data.qpos).all() and speed <= self.config.max_speed)

    def _contact_force(self) -> np.ndarray:
        force = np.zeros(len(HUMANOID.body_names))
        wrench = np.zeros(6)
        for index, pair in enumerate(self._data.contact.geom):
            mujoco.mj_contactForce(self._model, self._data, index, wrench)
            for geom in pair:
                body = self._bodies[geom]
                if body >= 0:
                    force[body] += wrench[0]
        return force

    def _geom_bodies(self) -> list[int]:
        """Return the humanoid's body index of each geom, -1 for the floor and balls."""
        bodies = [int(self._model.geom_bodyid[g]) - 1 for g in range(self._model.ngeom)]
        return [b if 0 <= b < len(HUMANOID.body_names) else -1 for b in bodies]

    def _use(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model is not self._model:
            self._model, self._data = model, data
            self._bodies = self._geom_bodies()

    def _flies_balls(self) -> bool:
        return self._model is not self._plain[0]

    def _bring_balls(self) -> None:
        """Go on in the model that has balls, from the same state."""
        if self._flies_balls():
            return
        if self._with_balls is None:
            model = compile_model(self.config.balls)
            self._with_balls = (model, mujoco.MjData(model))
        qpos, qvel = self._data.qpos.copy(), self._data.qvel.copy()
        self._use(*self._with_balls)
        mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[:QPOS_SIZE], self._data.qvel[:QVEL_SIZE] = qpos, qvel
        for index in range(self.config.balls):
            self._park_ball(index)

    def _next_ball(self) -> int:
        """Return a parked ball, or the oldest one."""
        ages = [np.inf if age is None else age for age in self._ball_ages]
        return int(np.argmax(ages))

    def _ball_geom(self, index: int) -> int:
        return self._model.geom(f"ball{index}").id

    def _balls(self) -> list[tuple[float, float]]:
        geoms = [self._ball_geom(i) for i in range(self.config.balls)]
        model = self._model
        return [(float(model.body_mass[model.geom_bodyid[g]]), float(model.geom_size[g, 0])) for g in geoms]

    def _shape_ball(self, index: int, mass_kg: float, radius_m: float) -> None:
        model, geom = self._model, self._ball_geom(index)
        body = model.geom_bodyid[geom]
        model.geom_size[geom], model.geom_rbound[geom] = (radius_m, 0.0, 0.0), radius_m
        model.body_mass[body] = mass_kg
        model.body_inertia[body] = 0.4 * mass_kg * radius_m**2
        # MuJoCo keeps the inertia of bodies that only translate and turn freely in constants of the model
        mujoco.mj_setConst(model, mujoco.MjData(model))
        self._let_touch(index, 1)

    def _let_touch(self, index: int, mask: int) -> None:
        """Set what a ball collides with; the broad phase looks at the body's masks."""
        model, geom = self._model, self._ball_geom(index)
        body = model.geom_bodyid[geom]
        model.geom_contype[geom] = model.geom_conaffinity[geom] = mask
        model.body_contype[body] = model.body_conaffinity[body] = mask

    def _park_ball(self, index: int) -> None:
        """Take a ball out of the world: out of reach, at rest, touching nothing, without weight."""
        self._let_touch(index, 0)
        qpos, qvel = QPOS_SIZE + 7 * index, QVEL_SIZE + 6 * index
        self._data.qpos[qpos : qpos + 7] = self._model.qpos0[qpos : qpos + 7]
        self._data.qvel[qvel : qvel + 6] = 0.0

    def _age_balls(self) -> None:
        if not self._flies_balls():
            return
        for index, age in enumerate(self._ball_ages):
            if age is not None:
                age += 1.0 / CONTROL_HZ
            self._ball_ages[index] = None if age is None or age > self.config.ball_lifetime_s else age
            if self._ball_ages[index] is None:
                self._park_ball(index)
        if all(age is None for age in self._ball_ages):
            qpos, qvel = self._data.qpos[:QPOS_SIZE].copy(), self._data.qvel[:QVEL_SIZE].copy()
            self._use(*self._plain)
            self._write(qpos, qvel)
