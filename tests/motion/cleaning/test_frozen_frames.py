"""Tests for frozen_frames.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import chosen, cleaned, figure, found, joined, lively, moved, turned


@pytest.mark.parametrize(("times", "rate_hz"), [(2, 60.0), (4, 120.0)])
def test_frames_repeated_to_fill_a_higher_rate_are_left_out(times, rate_hz):
    slow = lively(150, rate_hz / times)
    fast = chosen(lively(150, rate_hz), np.repeat(np.arange(150), times))
    fast = fast.__class__(**{**vars(fast), "local_quat": np.repeat(slow.local_quat, times, axis=0)})
    result = cleaned(fast)
    assert found(result) == [("resample", "repeated_frames")]
    (part,) = result.parts
    assert len(part.times_s) == 150
    assert np.allclose(np.diff(part.times_s), times / rate_hz)
    assert np.allclose(part.local_quat, slow.local_quat)


def test_repeats_that_differ_by_rounding_are_found_too():
    motion = chosen(lively(150), np.repeat(np.arange(150), 2))
    noise = np.random.default_rng(0).normal(0.0, 1e-5, 300)
    assert found(cleaned(turned(motion, "neck", "x", noise))) == [("resample", "repeated_frames")]


def test_a_single_repeated_frame_is_left_out_and_the_times_of_the_others_stay():
    order = np.concatenate([np.arange(100), [99], np.arange(101, 300)])
    result = cleaned(chosen(lively(300), order))
    assert [(d.reason, d.first) for d in result.decisions] == [("repeated_frames", 100)]
    times_s = result.parts[0].times_s
    assert np.isclose(times_s[100] - times_s[99], 2 / 60) and np.isclose(times_s[-1], 299 / 60)


def test_a_capture_that_stood_still_is_cut_out():
    held = np.concatenate([np.arange(150), np.full(40, 150), np.arange(160, 300)])
    result = cleaned(chosen(lively(300), held))
    assert found(result)[0] == ("cut", "frozen")
    assert abs(result.decisions[0].first - 150) <= 1 and abs(result.decisions[0].last - 190) <= 1
    assert len(result.parts) == 2


def test_a_held_pose_that_is_entered_and_left_slowly_stays():
    t = np.arange(240)
    angle = (
        0.8
        * np.cos(np.pi * np.clip((t - 100) / 60, 0.0, 0.5))
        * np.cos(np.pi * np.clip((180 - t) / 60, 0.0, 0.5))
    )
    motion = moved(turned(figure(240), "left_shoulder", "y", angle), np.outer(1e-3 * angle, [1.0, 0, 0]))
    assert ("cut", "frozen") not in found(cleaned(motion))


def test_a_frozen_end_is_cut():
    held = np.concatenate([np.arange(200), np.full(60, 199)])
    result = cleaned(chosen(lively(300), held))
    assert found(result) == [("cut", "frozen")]
    assert result.decisions[0].last == 259 and len(result.parts[0].times_s) in (199, 200)


def test_an_in_between_at_constant_speed_is_cut():
    count = 60
    first = lively(300)
    share = np.linspace(0.0, 1.0, count)
    start = figure(count)
    for joint in ("left_shoulder", "right_hip", "neck"):
        start = turned(start, joint, "y", 0.9 * share)
    start = moved(start, np.outer(share, [-0.5, 0.1, 0.0]))
    result = cleaned(joined(start, first))
    assert found(result)[0] == ("cut", "interpolated")
    assert result.decisions[0].first == 0 and abs(result.decisions[0].last - count) < 8
    assert "constant speed" in result.decisions[0].text
