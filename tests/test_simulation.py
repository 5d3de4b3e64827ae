"""Tests for simulation.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import standing, swaying
from tests.test_state import assert_same
from unicon.control import ServoControl, TorqueControl
from unicon.errors import UniconError, UnknownNameError
from unicon.humanoid import HUMANOID
from unicon.projectile import Projectile, aim
from unicon.simulation import Simulation
from unicon.state import CharacterState

REST = ServoControl(np.zeros(35), np.zeros(35))


def states_of(simulation: Simulation, controls: list) -> list[CharacterState]:
    states = []
    for control in controls:
        simulation.step(control)
        states.append(simulation.state)
    return states


def random_torques(count: int, seed: int = 0) -> list[TorqueControl]:
    rng = np.random.default_rng(seed)
    return [TorqueControl(HUMANOID.effort * rng.uniform(-1, 1, 35)) for _ in range(count)]


def test_the_servo_stands_still_for_a_minute():
    simulation = Simulation()
    for _ in range(3600):
        result = simulation.step(REST)
    assert np.allclose(simulation.state.root_pos_w, standing().root_pos_w, atol=0.005)
    assert np.isclose(result.contact_force.sum(), 70 * 9.81, rtol=1e-3)
    feet = [
        HUMANOID.body_names.index(f"{side}_{part}") for side in ("left", "right") for part in ("foot", "toe")
    ]
    assert np.isclose(result.contact_force[feet].sum(), result.contact_force.sum())


def test_ten_seconds_of_random_torque_never_blow_up():
    simulation = Simulation()
    for control in random_torques(600):
        assert simulation.step(control).finite
        qpos, qvel = simulation.state.to_mujoco()
        assert np.abs(qvel).max() < 150
        assert qpos[2] > 0.0


def test_the_same_controls_give_the_same_bits_whatever_went_before():
    fresh, used = Simulation(), Simulation()
    states_of(used, random_torques(30, seed=9))
    used.reset(HUMANOID.rest_state())
    for a, b in zip(states_of(fresh, random_torques(60)), states_of(used, random_torques(60)), strict=True):
        assert a.to_mujoco()[0].tobytes() == b.to_mujoco()[0].tobytes()


def test_a_snapshot_brings_back_everything():
    simulation = Simulation()
    simulation.throw(Projectile())
    states_of(simulation, [REST] * 3)
    snapshot = simulation.snapshot()
    first = states_of(simulation, [REST] * 20)
    simulation.restore(snapshot)
    again = states_of(simulation, [REST] * 20)
    assert first[-1].to_mujoco()[1].tobytes() == again[-1].to_mujoco()[1].tobytes()


def test_mirrored_torques_give_a_mirrored_motion():
    here, there = Simulation(), Simulation()
    for control in random_torques(15):
        here.step(TorqueControl(0.2 * control.torque))
        mirrored = (0.2 * control.torque)[HUMANOID.mirror_order] * HUMANOID.mirror_sign
        there.step(TorqueControl(mirrored))
    assert_same(HUMANOID.mirror(here.state), there.state, 1e-5)


def test_torques_beyond_the_effort_are_cut_off():
    result = Simulation().step(TorqueControl(np.full(35, 1e6)))
    assert np.all(result.torque <= HUMANOID.effort + 1e-9)


@pytest.mark.parametrize("torque", [np.full(35, np.nan), np.zeros(34)])
def test_a_control_that_is_no_control_is_refused(torque):
    with pytest.raises(ValueError, match="35 finite values"):
        Simulation().step(TorqueControl(torque))


def test_a_state_that_runs_away_is_taken_back():
    simulation = Simulation()
    simulation._data.qvel[:] = 1e8
    before = simulation.state
    assert not simulation.step(REST).finite
    assert_same(simulation.state, before)


def test_the_servo_follows_a_slow_motion_closely():
    simulation, path = Simulation(), swaying(120, speed=0.0)
    simulation.reset(path[0])
    for k in range(1, 120):
        simulation.step(ServoControl(path[k].joint_pos, (path[k].joint_pos - path[k - 1].joint_pos) * 60))
    assert np.abs(simulation.state.joint_pos - path[119].joint_pos).max() < 0.15


def test_balls_hit_and_are_gone_after_their_time():
    simulation = Simulation()
    simulation.throw(Projectile(mass_kg=10.0, speed_m_s=10.0))
    assert len(simulation.ball_positions_w) == 1
    lowest = min(state.root_pos_w[0] for state in states_of(simulation, [REST] * 30))
    assert lowest < -0.05
    states_of(simulation, [REST] * 300)
    assert len(simulation.ball_positions_w) == 0


def test_one_ball_too_many_takes_the_oldest_ones_place():
    simulation = Simulation()
    for _ in range(6):
        simulation.throw(Projectile(speed_m_s=1.0))
    assert len(simulation.ball_positions_w) == simulation.config.balls


def test_a_ball_that_misses_changes_nothing_but_is_there():
    with_ball, without = Simulation(), Simulation()
    with_ball.throw(Projectile(body="head", distance_m=10.0, speed_m_s=0.1, azimuth_rad=3.0))
    a, b = states_of(with_ball, [REST] * 10)[-1], states_of(without, [REST] * 10)[-1]
    assert_same(a, b, 1e-9)


def test_a_ball_is_aimed_at_where_the_body_is():
    projectile = Projectile(body="head", speed_m_s=20.0, azimuth_rad=np.pi / 2, distance_m=3.0)
    launch = aim(projectile, standing())
    time_s = 3.0 / 20.0
    arrival = launch.pos_w + launch.vel_w * time_s - np.array([0, 0, 0.5 * 9.81 * time_s**2])
    assert np.allclose(launch.pos_w, [0.0, 3.0, 1.47])
    assert np.allclose(arrival, [0.0, 0.0, 1.47])


@pytest.mark.parametrize("field", ["mass_kg", "radius_m", "speed_m_s", "distance_m", "azimuth_rad"])
@pytest.mark.parametrize("value", [-10.0, 1e9, float("nan")])
def test_a_projectile_out_of_range_is_refused_by_name(field, value):
    with pytest.raises(UniconError, match=field):
        Projectile(**{field: value})


def test_an_unknown_body_is_answered_with_the_nearest():
    with pytest.raises(UnknownNameError, match="left_hand"):
        Projectile(body="left_hnd")
