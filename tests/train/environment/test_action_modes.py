"""Tests for action_modes.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying
from unicon.control import ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.observation import policy_input, policy_input_size
from unicon.policy import NetworkPolicy, PolicyContext
from unicon.policy_file import PolicyCard, PolicyWeights
from unicon.state import CharacterState
from unicon.train.environment.action_modes import make_control, ticks_held

KNEE = HUMANOID.joint_names.index("left_knee")


def states(joint_pos: float, joint_vel: float = 0.0) -> CharacterState:
    values = vars(swaying(1)) | {
        "joint_pos": np.full((1, 35), joint_pos, np.float32),
        "joint_vel": np.full((1, 35), joint_vel, np.float32),
    }
    return CharacterState(**values)


def test_torque_is_the_action_times_the_effort():
    control = make_control("torque", np.full((1, 35), 0.25, np.float32), states(0.3), states(0.5, 1.0))
    assert isinstance(control, TorqueControl)
    assert control.torque.dtype == np.float32
    assert control.torque[0, KNEE] == pytest.approx(0.25 * HUMANOID.effort[KNEE])


def test_a_torque_servo_adds_stiffness_times_the_way_to_the_target_and_damping_times_its_velocity():
    control = make_control("torque-servo", np.full((1, 35), 0.1, np.float32), states(0.3), states(0.5, 2.0))
    assert isinstance(control, TorqueControl)
    by_hand = 0.1 * HUMANOID.effort + HUMANOID.stiffness * 0.2 + HUMANOID.damping * 2.0
    assert np.allclose(control.torque[0], by_hand, rtol=1e-5)


def test_a_pd_servo_in_the_state_that_it_was_made_in_gives_the_torque_of_the_torque_servo():
    actions = np.linspace(-0.3, 0.3, 35, dtype=np.float32)[None]
    actual, target = states(0.3, 4.0), states(0.35, 2.0)
    held = make_control("torque-servo", actions, actual, target)
    servo = make_control("pd", actions, actual, target)
    assert isinstance(held, TorqueControl) and isinstance(servo, ServoControl)
    # the formula of unicon.control.ServoControl, without the passive damping
    torque = HUMANOID.stiffness * (servo.joint_pos - actual.joint_pos) + HUMANOID.damping * servo.joint_vel
    assert np.allclose(torque, held.torque, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize("mode", ["torque", "torque-servo"])
def test_a_network_moves_the_avatar_as_the_executor_would(mode):
    rng = np.random.default_rng(0)
    size = policy_input_size(1)
    layers = ((rng.standard_normal((35, size)).astype(np.float32) * 0.01, np.zeros(35, np.float32)),)
    weights = PolicyWeights(layers, np.zeros(size, np.float32), np.ones(size, np.float32))
    card = PolicyCard("test", "", HUMANOID.id, "", 1, 60, mode, "relu", "")
    frames = swaying(9)
    context = PolicyContext(frames[0], frames[8:9])
    executor = NetworkPolicy(card, weights)
    seen = policy_input(context.actual, context.targets)
    actions = weights.evaluate(seen, "relu").astype(np.float32)[None]
    control = make_control(mode, actions, frames[0:1], frames[8:9])
    assert isinstance(control, TorqueControl)
    cut = np.clip(control.torque[0], -HUMANOID.effort, HUMANOID.effort)
    assert np.allclose(cut, executor.act(context).torque, rtol=1e-5, atol=1e-3)


def test_only_a_torque_servo_is_computed_again_within_a_control_step():
    assert [ticks_held(mode, 30) for mode in ("torque", "torque-servo", "pd", "kinematic")] == [2, 1, 2, 2]
    assert [ticks_held(mode, 60) for mode in ("torque", "torque-servo", "pd", "kinematic")] == [1, 1, 1, 1]
