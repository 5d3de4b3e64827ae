"""Tests for reward.py: each formula by hand, and the invariances."""

from __future__ import annotations

import numpy as np
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.reward import (
    RewardConfig,
    RewardTerms,
    breaks_constraint,
    reward_terms,
    total_reward,
    tracking_errors,
)
from unicon.state import CharacterState, move

from .test_state import random_state


def changed(state: CharacterState, **fields: np.ndarray) -> CharacterState:
    return CharacterState(**{**vars(state), **fields})


def terms_between(actual: CharacterState, target: CharacterState) -> RewardTerms:
    return reward_terms(tracking_errors(actual, target))


def test_a_target_met_exactly_gives_one():
    state = random_state(0)
    terms = terms_between(state, state)
    assert np.allclose(terms, 1.0)
    assert np.isclose(total_reward(terms), 1.0)
    assert not breaks_constraint(terms)


def test_half_a_metre_costs_the_root_position_alone():
    rest = HUMANOID.rest_state()
    away = changed(rest, root_pos_w=rest.root_pos_w + np.array([0.3, 0.0, 0.4]))
    terms = terms_between(rest, away)
    assert np.isclose(terms.root_position, np.exp(-10 * 0.25))
    assert np.allclose(terms[1:], 1.0)


def test_a_turn_about_the_vertical_costs_the_root_rotation_alone():
    rest = HUMANOID.rest_state()
    turned = changed(rest, root_quat_w=rotations.from_heading(np.array(0.7)))
    terms = terms_between(rest, turned)
    assert np.isclose(terms.root_rotation, np.exp(-2 * 0.7**2))
    assert np.allclose([terms.root_position, terms.joint_position, terms.joint_rotation], 1.0)


def test_one_bent_elbow_costs_by_the_mean_over_the_nineteen_joints():
    rest = HUMANOID.rest_state()
    elbow = HUMANOID.joint_names.index("left_elbow")
    direction = np.sign(HUMANOID.joint_lower[elbow] + HUMANOID.joint_upper[elbow])
    bent = rest.joint_pos.copy()
    bent[elbow] += direction * 0.9
    terms = terms_between(rest, changed(rest, joint_pos=bent))
    assert np.isclose(terms.joint_rotation, np.exp(-2 * 0.9**2 / 19))
    hand = HUMANOID.offsets[HUMANOID.body_names.index("left_hand")]
    chord = 2 * np.linalg.norm(hand) * np.sin(0.45)
    assert np.isclose(terms.joint_position, np.exp(-40 * chord**2 / 19))
    assert np.isclose(terms.joint_velocity, 1.0)


def test_one_turning_hinge_costs_by_its_square():
    rest = HUMANOID.rest_state()
    spinning = rest.joint_vel.copy()
    spinning[HUMANOID.joint_names.index("right_knee")] = 6.0
    terms = terms_between(rest, changed(rest, joint_vel=spinning))
    assert np.isclose(terms.joint_velocity, np.exp(-0.1 * 36 / 19))
    assert np.allclose(terms[:4], 1.0)


def test_the_weights_of_the_paper_add_up_to_one():
    assert RewardConfig().weights == (0.2, 0.2, 0.1, 0.4, 0.1)
    terms = RewardTerms(*np.eye(5))
    assert np.allclose(total_reward(terms), RewardConfig().weights)


def test_one_term_under_the_threshold_breaks_the_constraint():
    good = np.full(5, 0.11)
    assert not breaks_constraint(RewardTerms(*good))
    for index in range(5):
        bad = good.copy()
        bad[index] = 0.09
        assert breaks_constraint(RewardTerms(*bad))
    assert breaks_constraint(RewardTerms(*np.array([np.nan, 1, 1, 1, 1])))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 1000), st.floats(-3, 3), st.floats(-100, 100), st.floats(-100, 100))
def test_turning_or_shifting_the_whole_world_changes_no_error(seed, heading, x, y):
    actual, target = random_state(seed), random_state(seed + 1)
    offset = np.array([x, y, 0.0])
    before = tracking_errors(actual, target)
    after = tracking_errors(move(actual, heading, offset), move(target, heading, offset))
    assert np.allclose(before, after, rtol=1e-7, atol=1e-7)


def test_a_mirrored_pair_has_the_same_errors():
    actual, target = random_state(2), random_state(3)
    mirrored = tracking_errors(HUMANOID.mirror(actual), HUMANOID.mirror(target))
    assert np.allclose(mirrored, tracking_errors(actual, target))


def test_batches_and_torch_give_the_same():
    actual, target = random_state(4, 3), random_state(5, 3)
    batch = tracking_errors(actual, target)
    assert np.allclose(np.stack(batch)[:, 2], tracking_errors(actual[2], target[2]))

    def torched(s: CharacterState) -> CharacterState:
        return CharacterState(*(torch.from_numpy(v) for v in vars(s).values()))

    errors = tracking_errors(torched(actual), torched(target))
    assert np.allclose(torch.stack(list(errors)).numpy(), np.stack(batch))
