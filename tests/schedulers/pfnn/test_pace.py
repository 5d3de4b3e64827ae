"""Tests for pace.py."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from unicon.schedulers.pfnn.layout import GAITS
from unicon.schedulers.pfnn.pace import TURN_M, gaits_at


@given(st.floats(0, 6), st.floats(-4, 4))
def test_weights_are_shares(speed, turn_rate):
    weights = gaits_at(np.array(speed), np.array(turn_rate))
    assert np.isclose(weights.sum(), 1.0)
    assert weights.min() >= 0.0


def test_who_goes_faster_goes_in_the_next_gait():
    main = gaits_at(np.array([0.0, 1.2, 2.4, 3.5]), np.zeros(4)).argmax(axis=-1)
    assert [GAITS[index] for index in main] == ["stand", "walk", "jog", "run"]


def test_half_way_between_two_paces_both_gaits_count_alike():
    weights = gaits_at(np.array((1.75 + 2.05) / 2), np.array(0.0))
    assert np.isclose(weights[GAITS.index("walk")], 0.5)
    assert np.isclose(weights[GAITS.index("jog")], 0.5)


def test_stepping_round_on_the_spot_is_no_standing():
    turning = gaits_at(np.array(0.0), np.array(1.0 / TURN_M * 0.5))
    assert turning[GAITS.index("walk")] == 1.0
