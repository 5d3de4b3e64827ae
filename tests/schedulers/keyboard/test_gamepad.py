"""Tests for gamepad.py."""

from __future__ import annotations

import math

import pytest

from unicon.errors import UniconError
from unicon.schedulers.keyboard.gamepad import GamepadProfile, command_of

PROFILE = GamepadProfile()


def test_full_tilt_forward_walks_and_with_the_buttons_jogs_and_runs():
    axes, buttons = [0.0, 1.0, 0.0, 0.0], [0] * 8
    assert command_of(axes, buttons, PROFILE).velocity_h == (PROFILE.walk_m_s, 0.0)
    buttons[PROFILE.jog_button] = 1
    assert command_of(axes, buttons, PROFILE).velocity_h == (PROFILE.jog_m_s, 0.0)
    buttons[PROFILE.run_button] = 1
    assert command_of(axes, buttons, PROFILE).velocity_h == (PROFILE.run_m_s, 0.0)


def test_nobody_runs_backward():
    buttons = [0] * 8
    buttons[PROFILE.jog_button] = 1
    assert command_of([0.0, -1.0], buttons, PROFILE).velocity_h[0] == -PROFILE.walk_m_s


def test_a_stick_that_rests_a_little_off_asks_for_nothing():
    command = command_of([0.05, -0.08, 0.0, 0.09], [], PROFILE)
    assert command.stands


def test_left_and_turn_follow_their_sticks():
    command = command_of([0.55, 0.0, 0.0, -1.0], [], PROFILE)
    # (0.55 - 0.1) / 0.9 = 1/2
    assert command.velocity_h[1] == pytest.approx(PROFILE.side_m_s / 2)
    assert command.turn_rate == -PROFILE.turn_rad_s


def test_a_device_with_fewer_axes_rests():
    assert command_of([], [], PROFILE).stands


def test_a_stick_that_is_no_number_is_refused():
    with pytest.raises(UniconError, match="expected finite numbers"):
        command_of([0.0, math.nan], [], PROFILE)
