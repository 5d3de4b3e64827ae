"""Tests for tracking_errors.hpp: errors and reward terms are the library's."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.environment.batch_simulator.reference import random_states, simulate
from unicon.reward import reward_terms, tracking_errors
from unicon.state import CharacterState

STATES = random_states(200, beyond=0.1)


def near(states: CharacterState, distance: float) -> CharacterState:
    """States at about this distance in every number."""
    rng = np.random.default_rng(3)
    moved = [v + distance * rng.standard_normal(v.shape) for v in vars(states).values()]
    moved[1] /= np.linalg.norm(moved[1], axis=1, keepdims=True)
    return CharacterState(*(value.astype(np.float32).astype(float) for value in moved))


@pytest.mark.parametrize("distance", [0.0, 1e-3, 0.05, 0.5])
def test_the_errors_are_the_librarys(distance):
    target = near(STATES, distance)
    errors, expected = simulate(STATES).errors(target), tracking_errors(STATES, target)
    for name in expected._fields:
        np.testing.assert_allclose(
            getattr(errors, name), getattr(expected, name), rtol=1e-4, atol=1e-5, err_msg=name
        )


@pytest.mark.parametrize("distance", [0.0, 0.05, 0.5])
def test_the_reward_terms_are_the_librarys(distance):
    target = near(STATES, distance)
    terms = reward_terms(simulate(STATES).errors(target))
    expected = reward_terms(tracking_errors(STATES, target))
    np.testing.assert_allclose(np.stack(terms), np.stack(expected), atol=1e-5)


def test_errors_of_states_that_have_nothing_in_common_are_the_librarys():
    target = random_states(200, seed=11)
    errors, expected = simulate(STATES).errors(target), tracking_errors(STATES, target)
    np.testing.assert_allclose(np.stack(errors), np.stack(expected), rtol=1e-5, atol=1e-5)


def test_one_hinge_that_is_off_by_a_tenth_gives_a_hundredth_over_nineteen():
    target = CharacterState(**{**vars(STATES), "joint_pos": STATES.joint_pos + 0.1 * (np.arange(35) == 13)})
    np.testing.assert_allclose(simulate(STATES).errors(target).joint_rotation, 0.01 / 19, rtol=1e-3)
