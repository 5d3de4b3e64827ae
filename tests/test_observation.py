"""Tests for observation.py: the layout, hand-computed parts, and what must not change it."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.observation import (
    OBSERVATION_LAYOUT,
    OBSERVATION_SIZE,
    RELATION_SIZE,
    observe,
    policy_input,
    policy_input_size,
    relate,
)
from unicon.state import CharacterState, extrapolate, move, stack

from .test_state import random_state


def part(observation: np.ndarray, name: str) -> np.ndarray:
    start = 0
    for part_name, size in OBSERVATION_LAYOUT:
        if part_name == name:
            return observation[..., start : start + size]
        start += size
    raise KeyError(name)


def targets_of(state: CharacterState, tau: int) -> CharacterState:
    return stack([extrapolate(state, (k + 1) / 60) for k in range(tau)])


def test_the_sizes_are_those_of_the_documentation():
    assert (OBSERVATION_SIZE, RELATION_SIZE) == (197, 9)
    assert policy_input_size(1) == 403


def test_the_rest_pose_is_seen_as_it_is():
    rest = HUMANOID.rest_state()
    seen = observe(rest, forward_kinematics(rest))
    assert np.isclose(part(seen, "root_height")[0], rest.root_pos_w[2])
    assert np.allclose(part(seen, "root_rot6d_h"), [1, 0, 0, 0, 1, 0])
    assert not part(seen, "joint_vel").any()
    head = part(seen, "body_pos_h").reshape(19, 3)[HUMANOID.body_names.index("head") - 1]
    assert abs(head[1]) < 1e-12
    assert 0.3 < head[2] < 0.8


def test_a_motion_ahead_is_seen_ahead_whatever_the_heading():
    rest = HUMANOID.rest_state()
    walking = CharacterState(**{**vars(rest), "root_lin_vel_w": np.array([1.5, 0.0, 0.0])})
    turned = move(walking, 2.0, np.array([3.0, -4.0, 0.0]))
    seen = observe(turned, forward_kinematics(turned))
    assert np.allclose(part(seen, "body_lin_vel_h").reshape(20, 3), [1.5, 0, 0])


def test_a_target_ahead_and_turned_left_is_related_so():
    rest = HUMANOID.rest_state()
    facing_left = move(rest, np.pi / 2, np.zeros(3))
    target = move(facing_left, np.pi / 2, np.zeros(3))
    target = CharacterState(
        **{**vars(target), "root_pos_w": facing_left.root_pos_w + np.array([-0.2, 0.5, 0.1])}
    )
    relation = relate(facing_left, target)
    assert np.allclose(relation[:3], [0.5, 0.2, 0.1])
    assert np.allclose(relation[3:], [0, 1, 0, -1, 0, 0])


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 1000), st.floats(-3, 3), st.floats(-100, 100), st.floats(-100, 100))
def test_turning_or_shifting_the_whole_world_changes_nothing(seed, heading, x, y):
    actual, target = random_state(seed), random_state(seed + 1)
    offset = np.array([x, y, 0.0])
    before = policy_input(actual, targets_of(target, 2))
    moved = move(target, heading, offset)
    after = policy_input(move(actual, heading, offset), targets_of(moved, 2))
    assert np.allclose(before, after, atol=1e-8)


@pytest.mark.parametrize("tau", [1, 3, 8])
def test_the_policy_sees_itself_then_each_target_and_its_relation(tau):
    actual, targets = random_state(0), targets_of(random_state(1), tau)
    seen = policy_input(actual, targets)
    assert seen.shape == (policy_input_size(tau),)
    assert np.allclose(seen[:197], observe(actual, forward_kinematics(actual)))
    last = targets[tau - 1]
    assert np.allclose(seen[-9:], relate(actual, last))
    assert np.allclose(seen[-206:-9], observe(last, forward_kinematics(last)))


def test_batches_and_torch_give_the_same():
    actual, targets = random_state(0, 4), random_state(1, 4, 2)
    batch = policy_input(actual, targets)
    assert batch.shape == (4, policy_input_size(2))
    assert np.allclose(batch[3], policy_input(actual[3], targets[3]))

    def torched(s: CharacterState) -> CharacterState:
        return CharacterState(*(torch.from_numpy(v) for v in vars(s).values()))

    assert np.allclose(policy_input(torched(actual), torched(targets)).numpy(), batch, atol=1e-9)
