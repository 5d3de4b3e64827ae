"""Tests for steering.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.steering import LEASH, Steering, SteeringConfig

FORWARD = LocomotionCommand((1.2, 0.0))


def steer(steering: Steering, command: LocomotionCommand, frames: int, achieved=None, heading: float = 0.0):
    for _ in range(frames):
        asked = steering.steer(command, heading)
        steering.observe(np.array(asked.velocity_h if achieved is None else achieved))
    return asked


def test_a_standing_command_is_passed_on_as_it_is():
    assert Steering(SteeringConfig(), 0.0).steer(STAND, 0.7) is STAND


def test_it_sets_off_at_once_and_speeds_up_no_faster_than_a_body():
    steering = Steering(SteeringConfig(acceleration_m_s2=1.5, gain=0.0), 0.0)
    first = steer(steering, FORWARD, 1)
    second = steer(steering, FORWARD, 1)
    assert first.velocity_h[0] == pytest.approx(0.4 + 1.5 / 60)
    assert second.velocity_h[0] - first.velocity_h[0] == pytest.approx(1.5 / 60)
    assert steer(steering, FORWARD, 60).velocity_h[0] == pytest.approx(1.2)


def test_it_slows_down_as_fast_and_then_stands():
    steering = Steering(SteeringConfig(acceleration_m_s2=1.5), 0.0)
    steer(steering, FORWARD, 120)
    assert 0.0 < steer(steering, STAND, 40).velocity_h[0] < 0.5
    assert steer(steering, STAND, 40) is STAND


def test_what_is_missing_in_the_speed_is_asked_for_on_top_up_to_a_bound():
    config = SteeringConfig(gain=1.0, largest_m_s=0.5)
    steering = Steering(config, 0.0)
    steer(steering, FORWARD, 60)
    slow = steer(steering, FORWARD, 60, achieved=(1.0, 0.0))
    assert 1.2 < slow.velocity_h[0] < 1.5
    assert steer(steering, FORWARD, 600, achieved=(0.5, 0.0)).velocity_h[0] == pytest.approx(1.7)


def test_the_heading_is_held_while_no_turn_is_asked_for():
    steering = Steering(SteeringConfig(), 0.3)
    assert steer(steering, FORWARD, 30, heading=0.5).facing_w == pytest.approx(0.3)


def test_a_turn_leads_the_facing_at_its_rate_on_a_leash():
    steering = Steering(SteeringConfig(), 0.0)
    command = LocomotionCommand((1.0, 0.0), turn_rate=0.6)
    assert steer(steering, command, 30).facing_w == pytest.approx(0.3)
    assert steer(steering, command, 300).facing_w == pytest.approx(LEASH)


def test_a_facing_that_is_asked_for_is_passed_on():
    steering = Steering(SteeringConfig(), 0.0)
    assert steer(steering, LocomotionCommand(facing_w=1.5), 10).facing_w == 1.5
