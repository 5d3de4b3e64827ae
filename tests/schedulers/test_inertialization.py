"""Tests for inertialization.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon import rotations, state
from unicon.humanoid import HUMANOID
from unicon.schedulers.inertialization import begin_after
from unicon.state import CharacterState

HIP = HUMANOID.joint_names.index("left_hip_y")


def moving(
    velocity_w: tuple[float, float, float], hip: float = 0.0, hip_velocity: float = 0.0
) -> CharacterState:
    """The rest pose with one hinge bent, going along at a steady velocity."""
    rest = HUMANOID.rest_state()
    angles, rates = rest.joint_pos.copy(), rest.joint_vel.copy()
    angles[HIP], rates[HIP] = hip, hip_velocity
    return replace(rest, root_lin_vel_w=np.array(velocity_w), joint_pos=angles, joint_vel=rates)


def steady(first: CharacterState, count: int = 91) -> CharacterState:
    """A motion that goes on with its first velocities."""
    return state.stack([state.extrapolate(first, np.array(k / 60)) for k in range(count)])


def test_the_root_changes_its_speed_evenly_and_loses_half_of_the_transition():
    path = begin_after(steady(moving((1.2, 0.0, 0.0))), moving((0.0, 0.0, 0.0)), 1.0)
    # the way is the integral of 1.2 s(u): 1.2 (u^3 - u^4 / 2), by hand
    assert path.root_pos_w[29, 0] == pytest.approx(1.2 * 3 / 32)
    assert path.root_pos_w[59, 0] == pytest.approx(0.6)
    assert path.root_pos_w[89, 0] == pytest.approx(0.6 + 1.2 * 0.5)
    speeds = np.diff(path.root_pos_w[:, 0]) * 60
    assert np.all(np.diff(speeds) > -1e-9)
    assert speeds.max() == pytest.approx(1.2)


def test_a_hinge_that_is_off_comes_to_the_motion_in_the_transition():
    path = begin_after(steady(moving((0.0, 0.0, 0.0), hip=0.4)), moving((0.0, 0.0, 0.0)), 0.5)
    # half way the smooth step is one half
    assert path.joint_pos[14, HIP] == pytest.approx(0.4 * 0.5)
    assert np.allclose(path.joint_pos[29:, HIP], 0.4)


def test_a_limb_that_was_fast_does_not_carry_on_for_long():
    path = begin_after(steady(moving((0.0, 0.0, 0.0))), moving((0.0, 0.0, 0.0), hip_velocity=6.0), 0.5)
    # the largest of v t exp(-8 t / T) is v T / 8e
    assert 0.9 * 6.0 * 0.5 / (8 * np.e) < path.joint_pos[:, HIP].max() < 6.0 * 0.5 / (8 * np.e) + 1e-9


@settings(max_examples=25, deadline=None)
@given(st.floats(-3, 3), st.floats(-2, 2), st.floats(-2, 2), st.floats(0.2, 2.0))
def test_pose_and_velocity_go_on_without_a_jump_at_any_heading(heading, speed, hip_velocity, transition_s):
    turn = np.array(heading)
    end = state.move(moving((speed, 0.3, 0.1), 0.2, hip_velocity), turn, np.array([3.0, -2.0, 0.0]))
    motion = steady(state.move(moving((1.3, 0.0, 0.0), -0.3, 1.0), np.array(1.0), np.array([9.0, 9.0, 0.05])))
    path = begin_after(motion, end, transition_s)
    ahead = state.extrapolate(end, np.array(1 / 60))
    curve = 3.0 * (1 / 60) ** 2 * (4.0 + 16.0 * 5.0 / transition_s) / min(transition_s, 1.0)
    assert np.abs(path.root_pos_w[0] - ahead.root_pos_w).max() < curve
    assert np.abs(path.joint_pos[0] - ahead.joint_pos).max() < curve
    between = rotations.multiply(rotations.conjugate(ahead.root_quat_w), path.root_quat_w[0])
    assert np.abs(rotations.angle(between)) < 1e-6


@settings(max_examples=10, deadline=None)
@given(st.floats(-3, 3), st.floats(-5, 5))
def test_it_turns_and_moves_with_where_the_path_ends(heading, shift):
    end, motion = moving((0.7, 0.0, 0.0), 0.2, 1.0), steady(moving((1.3, 0.2, 0.0), -0.1, 2.0))
    here = begin_after(motion, end, 0.6)
    offset = np.array([shift, 1.0, 0.0])
    there = begin_after(motion, state.move(end, np.array(heading), offset), 0.6)
    count = here.batch_shape
    moved = state.move(here, np.full(count, heading), np.tile(offset, (*count, 1)))
    assert np.allclose(there.root_pos_w, moved.root_pos_w, atol=1e-9)
    assert np.allclose(there.joint_pos, moved.joint_pos)


def test_without_a_transition_only_place_and_heading_are_kept():
    motion = steady(state.move(moving((1.2, 0.0, 0.0), 0.3), np.array(0.5), np.array([4.0, 4.0, 0.0])))
    path = begin_after(motion, moving((0.0, 0.0, 0.0)), 0.0)
    assert np.allclose(path.root_pos_w[:2, 0], [1.2 / 60, 2.4 / 60])
    assert np.allclose(path.root_pos_w[:, 1], 0.0)
    assert np.allclose(path.joint_pos[:, HIP], 0.3)
