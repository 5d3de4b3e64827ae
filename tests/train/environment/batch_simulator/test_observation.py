"""Tests for observation.hpp: the policy's input is the library's."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.environment.batch_simulator.reference import random_states, simulate
from unicon.observation import policy_input
from unicon.state import CharacterState

STATES = random_states(40, beyond=0.1)


def targets(tau: int) -> CharacterState:
    flat = random_states(40 * tau, seed=7)
    return CharacterState(*(value.reshape(40, tau, -1) for value in vars(flat).values()))


@pytest.mark.parametrize("tau", [1, 3, 8])
def test_the_policy_input_is_the_librarys(tau):
    seen = simulate(STATES).observe(targets(tau))
    expected = policy_input(STATES, targets(tau))
    assert seen.dtype == np.float32
    np.testing.assert_allclose(seen, expected, rtol=1e-5, atol=1e-5)


def test_a_body_that_looks_straight_up_has_the_librarys_heading():
    up = np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])
    about_z = np.array([0.8, 0.0, 0.0, 0.6])
    turned = np.array([0.8 * up[0], -0.6 * up[2], 0.8 * up[2], 0.6 * up[0]])
    quat = np.stack([up, turned, about_z] + [up] * 37).astype(np.float32).astype(float)
    states = CharacterState(**{**vars(STATES), "root_quat_w": quat})
    seen = simulate(states).observe(targets(1))
    assert np.isfinite(seen).all()
    np.testing.assert_allclose(seen, policy_input(states, targets(1)), rtol=1e-5, atol=1e-5)
