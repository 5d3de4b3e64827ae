"""Tests for jumps.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.motion.retargeting.jumps import FASTEST_RAD_S, RAMP_RAD_S, spread_jumps


def test_what_is_slow_enough_stays_as_it_is():
    angles = np.sin(np.linspace(0, 20, 200))[:, None]
    assert np.array_equal(spread_jumps(angles), angles)


@given(st.integers(0, 58), st.floats(-6, 6))
def test_a_step_becomes_a_ramp_between_the_same_angles(frame, height):
    angles = np.where(np.arange(60) > frame, height, 0.0)[:, None]
    spread = spread_jumps(angles)
    assert np.abs(np.diff(spread[:, 0])).max() * 60 <= FASTEST_RAD_S + RAMP_RAD_S + 1e-9
    assert spread.min() >= min(height, 0.0) - 1e-9
    assert spread.max() <= max(height, 0.0) + 1e-9


def test_far_from_the_step_nothing_changes():
    angles = np.where(np.arange(200) > 100, 3.0, 0.0)[:, None]
    spread = spread_jumps(angles)
    assert spread[:90] == pytest.approx(0.0)
    assert spread[112:] == pytest.approx(3.0)
