"""Tests for simulators.py: both simulators under the same contract."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying
from tests.train.small_library import SIMULATORS
from unicon.control import ServoControl, TorqueControl
from unicon.observation import policy_input
from unicon.reward import tracking_errors
from unicon.target_frames import pack, unpack
from unicon.train.environment import simulators
from unicon.train.environment.batch_simulator.build import NoCompilerError
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.mujoco_simulator import MujocoSimulator
from unicon.train.environment.simulators import make_simulator

N = 20


def settings(name: str, **changes) -> EnvironmentConfig:
    return EnvironmentConfig(**{"simulator": name, "num_envs": N, "threads": 1, **changes})


@pytest.fixture(params=SIMULATORS)
def simulator(request):
    made = make_simulator(settings(request.param))
    made.put(pack(swaying(N, speed=1.0)), np.arange(N))
    return made


def targets(tau: int) -> np.ndarray:
    frames = pack(swaying(N + tau + 10, speed=1.0)).astype(np.float32)
    return np.stack([frames[10 + k : 10 + k + N] for k in range(tau)], axis=1)


def servo() -> ServoControl:
    return ServoControl(swaying(N).joint_pos, np.zeros((N, 35)))


def test_only_the_named_avatars_are_put_elsewhere(simulator):
    before = simulator.rows.copy()
    simulator.put(targets(1)[[4, 2], 0], np.array([3, 7]))
    others = np.setdiff1d(np.arange(N), [3, 7])
    assert np.array_equal(simulator.rows[others], before[others])
    assert np.allclose(simulator.rows[[3, 7]], targets(1)[[4, 2], 0], atol=1e-6)


def test_the_observation_is_the_library_s(simulator):
    expected = policy_input(unpack(simulator.rows.astype(float)), unpack(targets(3).astype(float)))
    seen = simulator.observe(targets(3))
    assert seen.dtype == np.float32
    assert np.allclose(seen, expected, atol=1e-5)


def test_some_avatars_see_what_they_would_see_among_all(simulator):
    envs = np.array([5, 2, 11])
    everything = simulator.observe(targets(2))
    assert np.allclose(simulator.observe(targets(2)[envs], envs), everything[envs], atol=1e-6)


def test_the_errors_are_the_library_s(simulator):
    expected = tracking_errors(unpack(simulator.rows.astype(float)), unpack(targets(1)[:, 0].astype(float)))
    errors = simulator.errors(targets(1)[:, 0])
    assert all(error.shape == (N,) and error.dtype == np.float32 for error in errors)
    assert np.allclose(np.stack(errors), np.stack(expected), atol=1e-5, rtol=1e-4)


def test_the_same_state_goes_on_to_the_same_bits(simulator):
    simulator.step(servo())
    start = simulator.rows.copy()
    simulator.step(servo())
    once = simulator.rows.copy()
    simulator.step(TorqueControl(np.ones((N, 35))))
    simulator.restore(start)
    simulator.step(servo())
    assert np.array_equal(simulator.rows, once)


def test_an_avatar_that_is_not_sound_is_told_and_can_be_put_back(simulator):
    good = simulator.rows[[4]].copy()
    bad = good.copy()
    bad[0, 20], bad[0, 60] = np.nan, np.inf
    simulator.put(bad, np.array([4]))
    assert np.flatnonzero(~simulator.step(servo())).tolist() == [4]
    simulator.put(good, np.array([4]))
    assert simulator.step(servo()).all()
    assert np.isfinite(simulator.rows).all()


@pytest.mark.parametrize("action", ["pd", "torque", "torque-servo"])
@pytest.mark.parametrize("name", SIMULATORS)
def test_a_control_is_held_as_long_as_the_mode_says(name, action):
    """A falling body tells the time: after t seconds of free fall its speed is g t."""
    made = make_simulator(settings(name, action=action, control_hz=30))
    rows = pack(swaying(N))
    rows[:, 2] += 5.0
    made.put(rows, np.arange(N))
    made.step(ServoControl(unpack(rows).joint_pos, np.zeros((N, 35))))
    held_s = 1 / 60 if action == "torque-servo" else 1 / 30
    assert np.allclose(made.rows[:, 9], -9.81 * held_s, atol=0.03)


@pytest.mark.parametrize("name", SIMULATORS)
def test_coarser_physics_take_as_much_time(name):
    made = make_simulator(settings(name, substeps=2, control_hz=60))
    rows = pack(swaying(N))
    rows[:, 2] += 5.0
    made.put(rows, np.arange(N))
    made.step(ServoControl(unpack(rows).joint_pos, np.zeros((N, 35))))
    assert np.allclose(made.rows[:, 9], -9.81 / 60, atol=0.03)


def test_without_a_compiler_mujoco_stands_in_and_says_so(monkeypatch):
    def fail(*_args):
        raise NoCompilerError("there is no g++")

    monkeypatch.setattr(simulators, "BatchSimulator", fail)
    said = []
    assert isinstance(make_simulator(settings("batch"), said.append), MujocoSimulator)
    assert said == ["there is no g++: going on with the mujoco simulator"]
