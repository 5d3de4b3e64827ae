"""Tests for simulator.py: batches, reproducibility, faults."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import standing
from tests.test_state import assert_same
from tests.train.environment.batch_simulator.reference import (
    MujocoReference,
    as_mujoco,
    random_servos,
    random_states,
    random_torques,
    simulate,
)
from unicon.control import ServoControl, TorqueControl
from unicon.state import CharacterState
from unicon.target_frames import pack
from unicon.train.environment.batch_simulator.build import FLAGS
from unicon.train.environment.batch_simulator.kernel import load_kernel
from unicon.train.environment.batch_simulator.simulator import BatchSimulator, BatchSimulatorConfig

STATES = random_states(53, height_m=0.8, speed=1.0)
CONTROL = random_servos(STATES)


def rows_after(states: CharacterState, control: ServoControl, ticks: int = 5, **config: object) -> np.ndarray:
    simulator = simulate(states, **config)
    for _ in range(ticks):
        simulator.step(control)
    return simulator.rows


def chosen(control: ServoControl, envs: object) -> ServoControl:
    return ServoControl(control.joint_pos[envs], control.joint_vel[envs])


def test_the_number_of_threads_changes_no_bit():
    once = rows_after(STATES, CONTROL)
    assert np.isfinite(once).all()
    for threads in (1, 2, 5):
        assert rows_after(STATES, CONTROL, threads=threads).tobytes() == once.tobytes()


def test_neighbours_change_no_bit():
    together = rows_after(STATES, CONTROL)
    for envs in (slice(0, 1), slice(10, 27), slice(52, 53), np.array([40, 3, 17])):
        alone = rows_after(STATES[envs], chosen(CONTROL, envs))
        assert alone.tobytes() == together[envs].tobytes()


def test_what_went_before_changes_no_bit():
    fresh = rows_after(STATES, CONTROL)
    used = simulate(random_states(53, seed=9))
    for _ in range(3):
        used.step(random_torques(53))
    used.set_state(STATES)
    for _ in range(5):
        used.step(CONTROL)
    assert used.rows.tobytes() == fresh.tobytes()


def test_not_a_number_stays_in_its_environment_and_is_reported():
    simulator = simulate(STATES)
    simulator.rows[7, 20] = np.nan
    simulator.rows[8, 0] = np.inf
    healthy = np.delete(np.arange(53), [7, 8])
    for _ in range(5):
        sound = simulator.step(CONTROL)
        assert sound[healthy].all()
        assert not sound[7]
        assert not sound[8]
    assert simulator.rows[healthy].tobytes() == rows_after(STATES, CONTROL)[healthy].tobytes()
    simulator.set_state(STATES[[7, 8]], [7, 8])
    assert simulator.step(CONTROL).all()


def test_a_state_that_runs_away_is_reported():
    simulator = simulate(STATES)
    simulator.rows[3, 7] = 1000.0
    sound = simulator.step(CONTROL)
    assert not sound[3]
    assert sound.sum() == 52


def test_states_go_in_and_come_out_by_mask_and_indices():
    simulator = BatchSimulator(6)
    mask = np.array([True, False, True, False, False, False])
    simulator.set_state(STATES[:2], mask)
    simulator.set_state(STATES[5], 4)
    assert_same(simulator.state()[mask], STATES[:2], 1e-6)
    assert_same(simulator.state()[4], STATES[5], 1e-6)
    assert_same(simulator.state()[1], standing(), 1e-6)
    assert np.shares_memory(simulator.state().joint_pos, simulator.rows)


def test_rows_of_targets_do_as_well_as_states():
    simulator = simulate(STATES)
    target = random_states(53, seed=4)
    rows = pack(target).astype(np.float32)
    assert (np.stack(simulator.errors(rows)) == np.stack(simulator.errors(target))).all()
    assert (simulator.observe(rows[:, None]) == simulator.observe(target[:, None])).all()


def test_thirty_hertz_is_one_tick_of_eight_steps():
    simulator = simulate(STATES, substeps=8)
    simulator.step(CONTROL)
    assert (simulator.rows == rows_after(STATES, CONTROL, ticks=2)).all()


def test_coarser_physics_is_mujocos_too():
    states = random_states(16)
    control = random_servos(states)
    simulator = simulate(states, substeps=1, timestep_s=1 / 120)
    simulator.step(control)
    _, expected = MujocoReference(1 / 120).step(states, control, substeps=1)
    np.testing.assert_allclose(as_mujoco(simulator)[1], expected, rtol=2e-5, atol=2e-5)


@pytest.mark.parametrize("shape", [(53, 34), (52, 35), (35,)])
def test_controls_of_the_wrong_shape_are_refused(shape):
    with pytest.raises(ValueError, match=r"\(53, 35\)"):
        simulate(STATES).step(TorqueControl(np.zeros(shape)))


def test_a_kernel_without_wide_vectors_does_the_same():
    plain_flags = tuple(flag for flag in FLAGS if flag != "-march=native")
    simulator = simulate(STATES, substeps=1)
    control = random_torques(53)
    wide = simulate(STATES, substeps=1)
    wide.step(control)
    simulator._kernel = load_kernel(("-O1", *plain_flags))
    assert simulator._kernel.unicon_lanes() == 4
    simulator.step(control)
    np.testing.assert_allclose(simulator.rows, wide.rows, rtol=1e-4, atol=1e-4)


def test_a_long_random_run_stays_sound():
    simulator = BatchSimulator(32, BatchSimulatorConfig(threads=1))
    for tick in range(300):
        assert simulator.step(random_torques(32, seed=tick // 6)).all()
    assert np.abs(simulator.rows).max() < 150
    assert (simulator.state().root_pos_w[:, 2] > 0.0).all()
