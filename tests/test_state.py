"""Tests for state.py."""

from __future__ import annotations

from dataclasses import fields

import mujoco
import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from unicon import rotations
from unicon.state import (
    CharacterState,
    concatenate,
    differentiate,
    extrapolate,
    hold,
    interpolate,
    move,
    stack,
)


def random_state(seed: int, *batch: int) -> CharacterState:
    rng = np.random.default_rng(seed)
    return CharacterState(
        root_pos_w=rng.standard_normal((*batch, 3)),
        root_quat_w=rotations.normalize(rng.standard_normal((*batch, 4))),
        root_lin_vel_w=rng.standard_normal((*batch, 3)),
        root_ang_vel_w=rng.standard_normal((*batch, 3)),
        joint_pos=rng.standard_normal((*batch, 35)),
        joint_vel=rng.standard_normal((*batch, 35)),
    )


def assert_same(a: CharacterState, b: CharacterState, tolerance: float = 1e-12) -> None:
    for f in fields(CharacterState):
        first, second = getattr(a, f.name), getattr(b, f.name)
        if f.name == "root_quat_w":
            first = first * np.sign(np.sum(first * second, axis=-1, keepdims=True))
        assert np.allclose(first, second, atol=tolerance), f.name


@given(st.integers(0, 10_000))
def test_mujoco_and_back_is_the_same_state(seed):
    state = random_state(seed, 2)
    qpos, qvel = state.to_mujoco()
    assert qpos.shape == (2, 42)
    assert qvel.shape == (2, 41)
    assert_same(CharacterState.from_mujoco(qpos, qvel), state)


def test_velocities_agree_with_mujocos_free_joint():
    xml = '<mujoco><worldbody><body name="b"><freejoint/><geom size=".1"/></body></worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    state = random_state(3)
    qpos, qvel = state.to_mujoco()
    data.qpos[:], data.qvel[:] = qpos[:7], qvel[:6]
    mujoco.mj_forward(model, data)
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, 1, velocity, 0)
    assert np.allclose(velocity[:3], state.root_ang_vel_w)
    assert np.allclose(velocity[3:], state.root_lin_vel_w)


def test_a_state_selects_along_its_batch():
    states = random_state(0, 5)
    assert states.batch_shape == (5,)
    assert states[2].batch_shape == ()
    assert_same(stack([states[i] for i in range(5)]), states)
    assert_same(concatenate([states[:2], states[2:]]), states)


def test_interpolation_meets_both_ends_and_the_middle():
    a, b = random_state(1), random_state(2)
    assert_same(interpolate(a, b, 0.0), a)
    assert_same(interpolate(a, b, 1.0), b, 1e-9)
    middle = interpolate(a, b, 0.5)
    assert np.allclose(middle.joint_pos, (a.joint_pos + b.joint_pos) / 2)
    to_a = rotations.multiply(rotations.conjugate(a.root_quat_w), middle.root_quat_w)
    to_b = rotations.multiply(rotations.conjugate(middle.root_quat_w), b.root_quat_w)
    assert np.isclose(rotations.angle(to_a), rotations.angle(to_b))


def test_extrapolation_moves_with_the_velocities():
    state = random_state(4)
    later = extrapolate(state, 0.1)
    assert np.allclose(later.root_pos_w, state.root_pos_w + 0.1 * state.root_lin_vel_w)
    assert np.allclose(later.joint_pos, state.joint_pos + 0.1 * state.joint_vel)
    turn = rotations.multiply(later.root_quat_w, rotations.conjugate(state.root_quat_w))
    assert np.allclose(rotations.to_rotation_vector(turn), 0.1 * state.root_ang_vel_w)


def test_a_held_state_keeps_its_pose_and_stands_still():
    state = random_state(5)
    held = hold(state)
    assert np.array_equal(held.joint_pos, state.joint_pos)
    assert not held.root_lin_vel_w.any()
    assert not held.root_ang_vel_w.any()
    assert not held.joint_vel.any()


@given(st.integers(0, 10_000), st.floats(-3, 3), st.floats(-5, 5), st.floats(-5, 5))
def test_a_move_and_its_opposite_cancel(seed, heading, x, y):
    state = random_state(seed)
    there = move(state, heading, np.array([x, y, 0.0]))
    back_turn = rotations.from_heading(np.array(-heading))
    back = move(there, -heading, -rotations.rotate(back_turn, np.array([x, y, 0.0])))
    assert_same(back, state, 1e-9)


def test_a_quarter_turn_moves_positions_and_velocities_alike():
    state = random_state(6)
    turned = move(state, np.pi / 2, np.array([1.0, 2.0, 3.0]))
    x, y, z = state.root_pos_w
    assert np.allclose(turned.root_pos_w, [1 - y, 2 + x, 3 + z])
    vx, vy, vz = state.root_lin_vel_w
    assert np.allclose(turned.root_lin_vel_w, [-vy, vx, vz])


def test_a_steady_motion_has_its_velocity_in_every_frame_up_to_the_ends():
    rate, count = 60.0, 12
    times = np.arange(count) / rate
    turn = np.array([0.3, -1.0, 2.0])
    path = differentiate(
        root_pos_w=times[:, None] * np.array([1.5, -0.5, 0.1]),
        root_quat_w=rotations.from_rotation_vector(times[:, None] * turn)
        * np.where(np.arange(count) % 2, -1.0, 1.0)[:, None],
        joint_pos=times[:, None] * np.linspace(-3, 3, 35),
        rate_hz=rate,
    )
    assert np.allclose(path.root_lin_vel_w, [1.5, -0.5, 0.1])
    assert np.allclose(path.root_ang_vel_w, turn)
    assert np.allclose(path.joint_vel, np.linspace(-3, 3, 35))


def test_an_accelerated_motion_is_as_fast_at_its_ends_as_it_should_be():
    times = np.arange(10) / 60.0
    position = np.stack([0.5 * 4.0 * times**2, 0 * times, 0 * times], axis=-1)
    still = np.tile([1.0, 0, 0, 0], (10, 1))
    path = differentiate(position, still, np.zeros((10, 35)), 60.0)
    assert np.allclose(path.root_lin_vel_w[:, 0], 4.0 * times)


def test_one_frame_has_no_velocity():
    with pytest.raises(ValueError, match="at least 2 frames"):
        differentiate(np.zeros((1, 3)), np.ones((1, 4)), np.zeros((1, 35)), 60.0)


def test_torch_states_interpolate_and_move_as_numpy_ones():
    a, b = random_state(7, 3), random_state(8, 3)

    def torched(s: CharacterState) -> CharacterState:
        return CharacterState(*(torch.from_numpy(v) for v in vars(s).values()))

    mixed = move(interpolate(torched(a), torched(b), torch.full((3,), 0.3)), 0.7, torch.ones(3))
    expected = move(interpolate(a, b, np.full(3, 0.3)), 0.7, np.ones(3))
    for f in fields(CharacterState):
        assert np.allclose(getattr(mixed, f.name).numpy(), getattr(expected, f.name)), f.name
