"""Tests for resampling.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.motion.figures import figure, moving
from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.retargeting.resampling import resample


def sampled(rate_hz, seconds=1.0):
    return figure(moving(round(rate_hz * seconds) + 1, rate_hz), rate_hz=rate_hz)


@pytest.mark.parametrize("rate_hz", [16.0, 24.0, 30.0, 60.0, 100.0, 120.0])
def test_there_are_sixty_frames_a_second_from_the_first_to_the_last(rate_hz):
    motion = sampled(rate_hz)
    dense = resample(motion)
    assert len(dense.times_s) == 61
    assert np.allclose(np.diff(dense.times_s), 1 / 60)
    assert np.allclose(dense.root_pos[[0, -1]], motion.root_pos[[0, -1]])


def test_time_begins_at_zero():
    motion = sampled(30.0)
    assert resample(replace(motion, times_s=motion.times_s + 5.0)).times_s[0] == 0.0


def test_a_motion_at_sixty_hertz_stays_as_it_is():
    motion = sampled(60.0)
    dense = resample(motion)
    assert np.allclose(np.abs(np.sum(dense.local_quat * motion.local_quat, axis=-1)), 1.0)
    assert np.allclose(dense.root_pos, motion.root_pos)


@given(st.lists(st.floats(-8, 8), min_size=3, max_size=3), st.floats(14, 130))
def test_a_steady_turn_stays_a_steady_turn(rate, rate_hz):
    """About a fixed axis at up to 14 rad/s: log(q[t]^-1 q[t+1]) is the same at every frame."""
    times = np.arange(int(rate_hz) + 2) / rate_hz
    turns = rotations.from_rotation_vector(times[:, None] * np.array(rate))
    motion = sampled(60.0, 0.2)
    local = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), len(motion.parents), 1))
    local[:, 0] = turns
    root = np.outer(times, [1.0, 2.0, -0.5])
    dense = resample(replace(motion, times_s=times, local_quat=local, root_pos=root))
    expected = rotations.from_rotation_vector(dense.times_s[:, None] * np.array(rate))
    error = rotations.angle(rotations.multiply(rotations.conjugate(expected), dense.local_quat[:, 0]))
    assert error.max() < 1e-6
    assert np.allclose(dense.root_pos, np.outer(dense.times_s, [1.0, 2.0, -0.5]))


@pytest.mark.parametrize("rate_hz", [24.0, 30.0])
def test_a_slow_source_comes_near_to_the_motion_between_its_frames(rate_hz):
    truth, dense = sampled(60.0), resample(sampled(rate_hz))
    error = rotations.angle(rotations.multiply(rotations.conjugate(truth.local_quat), dense.local_quat))
    assert error.max() < 0.02


@pytest.mark.parametrize("rate_hz", [120.0, 240.0])
def test_a_fast_source_does_not_lag(rate_hz):
    truth, dense = sampled(60.0), resample(sampled(rate_hz))
    error = rotations.angle(rotations.multiply(rotations.conjugate(truth.local_quat), dense.local_quat))
    assert error.max() < 0.01


def test_jitter_faster_than_sixty_hertz_can_show_is_averaged_away():
    motion = sampled(120.0)
    jitter = 0.01 * (-1.0) ** np.arange(len(motion.times_s))
    dense = resample(replace(motion, root_pos=motion.root_pos + jitter[:, None]))
    assert np.abs(dense.root_pos[1:-1] - resample(motion).root_pos[1:-1]).max() < 1e-9


def test_velocities_are_continuous_at_the_frames_of_a_slow_source():
    dense = resample(sampled(15.0))
    turns = rotations.multiply(rotations.conjugate(dense.local_quat[:-1]), dense.local_quat[1:])
    rates = 60 * rotations.to_rotation_vector(turns)
    assert np.abs(np.diff(rates, axis=0)).max() < 2.0


def test_places_that_change_over_time_are_interpolated():
    motion = sampled(30.0)
    local_pos = np.tile(motion.offsets, (len(motion.times_s), 1, 1)) * (1 + motion.times_s[:, None, None])
    dense = resample(replace(motion, local_pos=local_pos))
    assert dense.local_pos is not None
    assert np.allclose(dense.local_pos, motion.offsets * (1 + dense.times_s[:, None, None]))


def test_a_motion_of_no_length_is_refused():
    with pytest.raises(InputFileError, match="too short"):
        resample(sampled(200.0, 0.01))
