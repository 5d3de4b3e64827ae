"""Tests for pace_limit.py."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.schedulers.keyboard.pace_limit import PaceLimit, PaceLimitConfig


def test_a_speed_beyond_the_play_is_cut_and_the_mean_rises_by_the_acceleration():
    limit = PaceLimit(PaceLimitConfig(acceleration_m_s2=1.2, play_m_s=0.25, smooth_s=0.1))
    assert limit.share(1.0) == pytest.approx(0.25)
    # 0.25 m/s above the mean over 6 frames would be 0.042 a frame; 1.2 / 60 are allowed
    assert limit.mean_m_s == pytest.approx(0.02)
    assert limit.share(0.27) == pytest.approx(1.0)


def test_what_slows_down_is_left_alone():
    limit = PaceLimit(PaceLimitConfig())
    limit.mean_m_s = 2.0
    assert [limit.share(speed) for speed in (2.2, 1.0, 0.5, 0.0)] == [1.0, 1.0, 1.0, 1.0]


@given(st.lists(st.floats(0.0, 5.0), min_size=1, max_size=200))
def test_the_speed_never_rises_faster_than_the_acceleration_and_the_play_allow(speeds):
    config = PaceLimitConfig()
    limit = PaceLimit(config)
    for frame, speed in enumerate(speeds):
        share = limit.share(speed)
        assert 0.0 <= share <= 1.0
        assert share * speed <= config.acceleration_m_s2 * frame / 60.0 + config.play_m_s + 1e-9
