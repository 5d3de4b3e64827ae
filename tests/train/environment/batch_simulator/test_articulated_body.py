"""Tests for articulated_body.hpp and integration.hpp: motion in the air, against MuJoCo and mechanics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from tests.train.environment.batch_simulator.reference import (
    MujocoReference,
    as_mujoco,
    random_servos,
    random_states,
    random_torques,
    simulate,
)
from unicon.control import TorqueControl
from unicon.state import CharacterState

STATES = random_states(64)
NO_TORQUE = TorqueControl(np.zeros((64, 35)))


@pytest.mark.parametrize("control", [random_torques(64), random_servos(STATES)], ids=["torque", "servo"])
def test_a_step_in_the_air_is_mujocos(control):
    simulator = simulate(STATES, substeps=1)
    assert simulator.step(control).all()
    expected_qpos, expected_qvel = MujocoReference().step(STATES, control, substeps=1)
    qpos, qvel = as_mujoco(simulator)
    assert np.abs(expected_qvel - STATES.to_mujoco()[1]).max() > 10.0
    np.testing.assert_allclose(qvel, expected_qvel, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(qpos, expected_qpos, atol=1e-6)


def test_a_second_in_the_air_stays_with_mujoco():
    states = random_states(8, seed=1, height_m=20.0)
    control = random_servos(states, size=0.1)
    simulator = simulate(states, substeps=240)
    simulator.step(control)
    expected_qpos, _ = MujocoReference().step(states, control, substeps=240)
    np.testing.assert_allclose(as_mujoco(simulator)[0], expected_qpos, atol=2e-4)


def momentum(states: CharacterState) -> tuple[np.ndarray, np.ndarray]:
    """Return the linear and the angular momentum about the centre of mass, each ``(N, 3)``."""
    reference, linear, angular = MujocoReference(), [], []
    for qpos, qvel in zip(*states.to_mujoco(), strict=True):
        reference.put(qpos, qvel)
        mujoco.mj_forward(reference.model, reference.data)
        mujoco.mj_subtreeVel(reference.model, reference.data)
        linear.append(reference.data.subtree_linvel[1] * reference.model.body_subtreemass[1])
        angular.append(reference.data.subtree_angmom[1].copy())
    return np.array(linear), np.array(angular)


def momentum_errors(timestep_s: float) -> tuple[float, float]:
    """Return how far both momenta are from what gravity makes of them in 0.1 s of free fall."""
    states = random_states(16, seed=2, height_m=50.0)
    simulator = simulate(states, substeps=round(0.1 / timestep_s), timestep_s=timestep_s)
    simulator.step(random_servos(states))
    linear_before, angular_before = momentum(states)
    linear, angular = momentum(simulator.state())
    fall = 70.0 * 0.1 * np.array([0.0, 0.0, -9.81])
    linear_error = np.abs(linear - linear_before - fall).max()
    return float(linear_error), float(np.abs(angular - angular_before).max())


def test_wrestling_with_oneself_in_free_fall_changes_momentum_less_the_shorter_the_step():
    """The momenta are about 200 N s and 70 N m s, and the limbs are moved with up to 600 N m."""
    coarse, fine = momentum_errors(0.002), momentum_errors(0.0005)
    assert coarse[0] < 4.0
    assert coarse[1] < 1.5
    assert fine[0] < coarse[0] / 3
    assert fine[1] < coarse[1] / 3


def kinetic_energy(states: CharacterState) -> np.ndarray:
    reference, energies = MujocoReference(), []
    reference.model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    for qpos, qvel in zip(*states.to_mujoco(), strict=True):
        reference.put(qpos, qvel)
        mujoco.mj_forward(reference.model, reference.data)
        mujoco.mj_energyVel(reference.model, reference.data)
        energies.append(reference.data.energy[1])
    return np.array(energies)


def energy_drift(timestep_s: float) -> float:
    """Return by which share the energy changes, on average, in 0.1 s without gravity and damping."""
    states = random_states(16, seed=3, height_m=50.0, speed=1.0, beyond=-0.25)
    options = {"substeps": round(0.1 / timestep_s), "timestep_s": timestep_s}
    simulator = simulate(states, gravity_m_s2=0.0, damping_scale=0.0, **options)
    simulator.step(TorqueControl(np.zeros((16, 35))))
    return float(np.abs(kinetic_energy(simulator.state()) / kinetic_energy(states) - 1.0).mean())


def test_energy_is_kept_but_for_an_error_that_shrinks_with_the_step():
    coarse, fine = energy_drift(0.002), energy_drift(0.0005)
    assert coarse < 0.01
    assert fine < coarse / 3


def test_damping_takes_energy_away():
    states = random_states(16, seed=3, height_m=50.0, speed=1.0)
    simulator = simulate(states, gravity_m_s2=0.0)
    simulator.step(TorqueControl(np.zeros((16, 35))))
    assert (kinetic_energy(simulator.state()) < kinetic_energy(states)).all()
