"""Tests for phases.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.train.pfnn.phases import STEP_S, label_phases, touch_downs


def contacts(events: list[tuple[int, int]], count: int, stance: int = 20) -> np.ndarray:
    """Feet that come down at frames and stand for a while; both stand at first."""
    contact = np.zeros((count, 2), bool)
    contact[:5] = True
    for frame, foot in events:
        contact[frame : frame + stance, foot] = True
    return contact


def test_a_foot_that_stands_at_first_has_not_come_down():
    assert touch_downs(contacts([(40, 1), (70, 0)], 100)) == [(40, 1), (70, 0)]


def test_the_phase_is_0_at_the_left_and_pi_at_the_right_touch_down_and_even_between():
    phase = label_phases(contacts([(60, 0), (90, 1), (120, 0)], 150))
    assert np.sin(phase[60]) == pytest.approx(0.0, abs=0.12)
    assert np.cos(phase[60]) > 0.99
    assert phase[90] % (2 * np.pi) == pytest.approx(np.pi)
    assert phase[90] - phase[75] == pytest.approx(np.pi / 2, abs=1e-3)


def test_it_waits_in_a_rest_and_goes_on_just_before_the_next_step():
    phase = label_phases(contacts([(60, 0), (240, 1)], 300))
    lift = 240 - round(STEP_S * 60)
    assert np.allclose(phase[80 : lift - 15], phase[80])
    assert phase[260] - phase[lift - 20] == pytest.approx(np.pi)
    assert np.allclose(phase[260:], phase[260])


def test_two_steps_of_one_foot_are_a_whole_cycle():
    phase = label_phases(contacts([(60, 0), (110, 0)], 150))
    assert phase[-1] - phase[0] == pytest.approx(2 * np.pi + np.pi)


def test_both_feet_that_come_to_rest_at_once_make_one_step():
    assert touch_downs(contacts([(60, 0), (64, 1)], 100)) == [(60, 0)]


def test_the_phase_goes_on_smoothly():
    phase = label_phases(contacts([(60, 0), (90, 1), (120, 0), (300, 1)], 400))
    assert np.abs(np.diff(phase, n=2)).max() < 0.02


def test_the_phase_never_falls_and_standing_has_none():
    rng = np.random.default_rng(3)
    contact = rng.random((200, 2)) < 0.5
    assert np.all(np.diff(label_phases(contact)) >= 0.0)
    assert not label_phases(np.ones((50, 2), bool)).any()


def test_a_foot_that_is_set_down_anew_at_once_makes_no_cycle():
    contact = np.zeros((100, 2), dtype=bool)
    contact[20:60, 0] = contact[70:, 0] = contact[40:80, 1] = True
    contact[50:55, 1] = False  # the right foot taps
    assert touch_downs(contact) == [(20, 0), (40, 1), (70, 0)]
