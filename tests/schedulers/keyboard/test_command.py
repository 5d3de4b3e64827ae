"""Tests for command.py."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.schedulers.keyboard.steerable import CARD
from unicon.errors import UniconError
from unicon.schedulers.keyboard.command import STAND, LocomotionCommand, clamp


@pytest.mark.parametrize(
    "numbers",
    [
        {"velocity_h": (math.nan, 0.0)},
        {"velocity_h": (0.0, math.inf)},
        {"turn_rate": math.nan},
        {"facing_w": math.inf},
    ],
)
def test_numbers_that_are_not_finite_are_refused(numbers):
    with pytest.raises(UniconError, match="expected finite numbers"):
        LocomotionCommand(**numbers)


def test_an_unknown_gait_is_refused_with_those_there_are():
    with pytest.raises(UniconError, match="no gait 'hop'; there are stand, walk"):
        LocomotionCommand(gait="hop")


def test_what_the_network_can_do_is_left_as_it_is():
    command = LocomotionCommand((1.2, 0.1), 0.7)
    assert clamp(command, CARD) == (command, ())


def test_too_much_is_clamped_and_said():
    clamped, changes = clamp(LocomotionCommand((6.0, 0.0), -4.0), CARD)
    assert clamped.velocity_h == pytest.approx((3.0, 0.0))
    assert clamped.turn_rate == -1.5
    assert changes == ("speed 6.00 to 3.00 m/s", "turn rate -4.00 to -1.50 rad/s")


@given(st.floats(-9, 9), st.floats(-9, 9))
def test_a_clamped_velocity_keeps_its_direction_and_lies_in_the_ellipse(x, y):
    ((vx, vy),) = [clamp(LocomotionCommand((x, y)), CARD).command.velocity_h]
    assert abs(vx * y - vy * x) < 1e-6
    along = 3.0 if vx >= 0 else 1.0
    assert math.hypot(vx / along, vy / 0.8) < 1.0 + 1e-6


def test_a_gait_sets_the_range_of_the_speed():
    assert clamp(LocomotionCommand((3.0, 0.0), gait="walk"), CARD).command.velocity_h == (1.6, 0.0)
    assert clamp(LocomotionCommand((0.5, 0.0), gait="jog"), CARD).command.velocity_h == (1.8, 0.0)
    assert clamp(LocomotionCommand((1.0, 0.0), gait="stand"), CARD).command.velocity_h == (0.0, 0.0)


def test_only_a_command_without_velocity_and_turn_stands():
    assert STAND.stands
    assert not LocomotionCommand((0.1, 0.0)).stands
    assert not LocomotionCommand(turn_rate=0.2).stands
    assert not LocomotionCommand(facing_w=0.0).stands
