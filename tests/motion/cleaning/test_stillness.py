"""Tests for stillness.py."""

from __future__ import annotations

import numpy as np

from tests.motion.cleaning.figures import cleaned, figure, found, lively, moved, turned


def waits(before: int, moves: int, after: int):
    """Stand still as people do, move, stand still."""
    count = before + moves + after
    t = np.arange(count)
    envelope = np.clip((t - before) / 30, 0.0, 1.0) * np.clip((before + moves - t) / 30, 0.0, 1.0)
    motion = turned(figure(count), "chest", "y", 0.01 * np.sin(0.05 * t))
    for joint in ("left_shoulder", "right_shoulder", "left_hip", "right_hip"):
        motion = turned(motion, joint, "y", envelope * np.sin(0.15 * t))
    return moved(motion, np.outer(np.cumsum(envelope) * 0.02, [1.0, 0.0, 0.0]))


def test_long_waiting_before_and_after_is_cut_down():
    result = cleaned(waits(300, 240, 400))
    assert found(result) == [("cut", "idle_end"), ("cut", "idle_end")]
    assert len(result.parts) == 1
    assert 240 <= len(result.parts[0].times_s) <= 400


def test_short_waiting_stays():
    assert found(cleaned(waits(90, 240, 90))) == []


def test_a_take_that_is_all_idle_stays():
    t = np.arange(900)
    motion = turned(figure(900), "chest", "y", 0.02 * np.sin(0.05 * t))
    motion = moved(motion, np.outer(0.01 * np.sin(0.03 * t), [0.0, 1.0, 0.0]))
    assert found(cleaned(motion)) == []


def test_a_lively_take_has_no_idle_ends():
    assert found(cleaned(lively(600))) == []
