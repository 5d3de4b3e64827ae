"""Tests for hinge.hpp: efforts and the ends of the joints' ranges."""

from __future__ import annotations

import numpy as np

from tests.samples import standing
from tests.train.environment.batch_simulator.reference import (
    MujocoReference,
    as_mujoco,
    random_servos,
    random_states,
    simulate,
)
from unicon.control import ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.state import CharacterState, stack


def in_the_air(count: int) -> CharacterState:
    rest = standing()
    high = CharacterState(**{**vars(rest), "root_pos_w": np.array([0.0, 0.0, 20.0])})
    return stack([high] * count)


def test_a_step_beyond_the_joints_limits_is_mujocos():
    states = random_states(128, beyond=0.1)
    control = random_servos(states)
    simulator = simulate(states, substeps=1)
    simulator.step(control)
    _, expected = MujocoReference().step(states, control, substeps=1)
    np.testing.assert_allclose(as_mujoco(simulator)[1], expected, rtol=1e-4, atol=1e-4)


def test_torques_beyond_the_effort_are_cut_off():
    states = in_the_air(2)
    simulator = simulate(states)
    simulator.step(TorqueControl(np.stack([HUMANOID.effort, 1e6 * HUMANOID.effort])))
    assert (simulator.rows[0] == simulator.rows[1]).all()


def test_servos_beyond_the_effort_are_cut_off():
    states = in_the_air(2)
    full = HUMANOID.effort / HUMANOID.stiffness
    simulator = simulate(states, substeps=1)
    simulator.step(ServoControl(np.stack([1.01 * full, 100.0 * full]), np.zeros((2, 35))))
    assert (simulator.rows[0] == simulator.rows[1]).all()


def test_full_effort_does_not_turn_a_joint_far_beyond_its_range():
    sign = np.random.default_rng(0).choice([-1.0, 1.0], (16, 35))
    simulator = simulate(in_the_air(16), substeps=240)
    simulator.step(TorqueControl(sign * HUMANOID.effort))
    joint_pos = simulator.state().joint_pos
    assert (joint_pos < HUMANOID.joint_upper + 0.25).all()
    assert (joint_pos > HUMANOID.joint_lower - 0.25).all()
