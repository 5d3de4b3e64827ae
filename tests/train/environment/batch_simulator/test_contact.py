"""Tests for contact.hpp and constraint_solver.hpp: on the floor, against MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from tests.samples import standing
from tests.train.environment.batch_simulator.reference import (
    JOINTS,
    MujocoReference,
    as_mujoco,
    rounded,
    simulate,
)
from unicon.control import ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.state import CharacterState, stack

REST = ServoControl(np.zeros((1, JOINTS)), np.zeros((1, JOINTS)))


def on_the_floor(torque: bool, seconds: float = 1.5, runs: int = 4) -> tuple[CharacterState, np.ndarray]:
    """Fall from 0.2 m, wriggle, and return every third tick's state and control."""
    rng = np.random.default_rng(5)
    reference, states, controls = MujocoReference(), [], []
    for _ in range(runs):
        reference.put(*at_height(1.15).to_mujoco())
        for tick in range(round(60 * seconds)):
            if tick % 10 == 0:
                aims = rng.standard_normal((1, JOINTS)) * (0.2 * HUMANOID.effort if torque else 0.4)
                reference.data.ctrl[:] = reference.values(control_of(aims, torque))[0]
            if tick % 3 == 0:
                states.append(
                    CharacterState.from_mujoco(reference.data.qpos.copy(), reference.data.qvel.copy())
                )
                controls.append(aims[0])
            mujoco.mj_step(reference.model, reference.data, 4)
    return rounded(stack(states)), np.array(controls)


def control_of(values: np.ndarray, torque: bool) -> ServoControl | TorqueControl:
    return TorqueControl(values) if torque else ServoControl(values, np.zeros_like(values))


def at_height(height_m: float, **changes: np.ndarray) -> CharacterState:
    return CharacterState(**{**vars(standing()), "root_pos_w": np.array([0.0, 0.0, height_m]), **changes})


@pytest.mark.parametrize("torque", [False, True], ids=["servo", "torque"])
def test_a_tick_on_the_floor_is_mujocos(torque):
    states, values = on_the_floor(torque)
    control = control_of(values, torque)
    simulator = simulate(states)
    assert simulator.step(control).all()
    expected_qpos, expected_qvel = MujocoReference().step(states, control, substeps=4)
    qpos, qvel = as_mujoco(simulator)
    difference = np.abs(qvel - expected_qvel).max(axis=1)
    assert np.abs(expected_qvel - states.to_mujoco()[1]).max() > 5.0
    assert np.median(difference) < 2e-5
    assert np.quantile(difference, 0.98) < 1e-3
    assert np.abs(qpos - expected_qpos).max() < 1e-3


def test_half_a_second_on_the_floor_stays_with_mujoco():
    states, values = on_the_floor(torque=False)
    control = control_of(values, torque=False)
    simulator = simulate(states, substeps=120)
    simulator.step(control)
    expected_qpos, _ = MujocoReference().step(states, control, substeps=120)
    difference = np.abs(as_mujoco(simulator)[0] - expected_qpos).max(axis=1)
    assert np.quantile(difference, 0.9) < 1e-3
    assert difference.max() < 0.1


def test_few_solves_are_coarser_but_near():
    states, values = on_the_floor(torque=False)
    control = control_of(values, torque=False)
    _, expected = MujocoReference().step(states, control, substeps=4)
    error = []
    for solves in (1, 2, 6):
        simulator = simulate(states, constraint_solves=solves)
        simulator.step(control)
        error.append(np.sqrt(np.mean((as_mujoco(simulator)[1] - expected) ** 2)))
    assert error[0] > error[1] > error[2]
    assert error[1] < 0.5


def test_a_dropped_body_comes_to_rest_at_mujocos_height():
    dropped = stack([at_height(1.0)])
    simulator = simulate(dropped, substeps=240)
    for _ in range(3):
        simulator.step(REST)
    expected_qpos, _ = MujocoReference().step(dropped, REST, substeps=720)
    _, qvel = as_mujoco(simulator)
    assert abs(simulator.state().root_pos_w[0, 2] - expected_qpos[0, 2]) < 1e-5
    assert np.abs(qvel).max() < 0.01


def test_it_rests_on_its_soles_with_its_weight():
    """Each of 16 corners carries about 43 N: less than a millimetre of depth."""
    simulator = simulate(stack([at_height(0.95)]), substeps=480)
    simulator.step(REST)
    assert 0.9485 < simulator.state().root_pos_w[0, 2] < 0.95


def test_a_sliding_body_stops_where_mujocos_does():
    lying = np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])
    states = stack(
        [
            at_height(
                0.12, root_quat_w=lying, root_lin_vel_w=np.array([2.0 * np.cos(a), 2.0 * np.sin(a), 0.0])
            )
            for a in (0.0, 0.8, 1.6)
        ]
    )
    still = ServoControl(np.zeros((3, JOINTS)), np.zeros((3, JOINTS)))
    simulator = simulate(states, substeps=240)
    for _ in range(2):
        simulator.step(still)
    expected_qpos, _ = MujocoReference().step(states, still, substeps=480)
    distance = np.linalg.norm(simulator.state().root_pos_w[:, :2], axis=1)
    expected = np.linalg.norm(expected_qpos[:, :2], axis=1)
    assert (expected > 0.15).all()
    np.testing.assert_allclose(distance, expected, rtol=1e-3)


def test_nothing_pulls_a_body_that_leaves_the_floor():
    states = stack(
        [
            at_height(0.945, root_lin_vel_w=np.array([0.0, 0.0, 3.0])),
            at_height(9.0, root_lin_vel_w=np.array([0.0, 0.0, 3.0])),
        ]
    )
    simulator = simulate(states)
    simulator.step(ServoControl(np.zeros((2, JOINTS)), np.zeros((2, JOINTS))))
    velocity = simulator.state().root_lin_vel_w[:, 2]
    assert velocity[0] >= velocity[1] - 1e-4
