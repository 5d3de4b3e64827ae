"""Tests for mujoco_simulator.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying
from unicon.control import ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.simulation import Simulation
from unicon.target_frames import pack
from unicon.train.environment.mujoco_simulator import MujocoSimulator


@pytest.mark.parametrize("servo", [False, True])
def test_four_ticks_are_those_of_the_executor(servo):
    rng = np.random.default_rng(0)
    states = swaying(3, speed=1.0)
    simulator = MujocoSimulator(3, substeps=4, timestep_s=1 / 240, threads=2)
    simulator.put(pack(states), np.arange(3))
    executors = [Simulation() for _ in range(3)]
    for executor, env in zip(executors, range(3), strict=True):
        executor.reset(states[env])
    for _ in range(4):
        actions = rng.uniform(-1.2, 1.2, (3, 35))
        if servo:
            control = ServoControl(actions, 3.0 * actions)
            singles = [ServoControl(row, 3.0 * row) for row in actions]
        else:
            control = TorqueControl(HUMANOID.effort * actions)
            singles = [TorqueControl(HUMANOID.effort * row) for row in actions]
        assert simulator.step(control).all()
        for executor, single in zip(executors, singles, strict=True):
            executor.step(single)
    expected = np.stack([pack(executor.state) for executor in executors])
    assert np.allclose(simulator.rows, expected, rtol=0, atol=1e-9)


def test_controls_of_one_kind_do_not_act_on_in_the_other():
    simulator = MujocoSimulator(1, substeps=4, timestep_s=1 / 240, threads=1)
    start = simulator.rows.copy()
    rest = TorqueControl(np.zeros((1, 35)))
    simulator.step(rest)
    expected = simulator.rows.copy()
    simulator.restore(start)
    simulator.step(ServoControl(np.ones((1, 35)), np.zeros((1, 35))))
    simulator.restore(start)
    simulator.step(rest)
    assert np.array_equal(simulator.rows, expected)


def test_quaternions_are_brought_to_unit_length():
    rows = pack(swaying(1))
    rows[:, 3:7] *= 1.001
    simulator = MujocoSimulator(1, substeps=4, timestep_s=1 / 240, threads=1)
    simulator.put(rows, np.array([0]))
    assert np.linalg.norm(simulator.rows[0, 3:7]) == pytest.approx(1.0, abs=1e-12)
