"""Tests for root_jumps.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import cleaned, figure, found, lively, moved, turned


def test_a_jump_of_the_root_cuts_without_losing_a_frame():
    motion = moved(lively(300), np.outer(np.arange(300) >= 120, [0.0, 0.3, 0.0]))
    result = cleaned(motion)
    assert [(d.reason, d.first) for d in result.decisions] == [("root_jump", 120)]
    assert [len(part.times_s) for part in result.parts] == [120, 180]


def test_a_spike_of_the_root_is_cut_out():
    offset = np.zeros((300, 3))
    offset[150:153] = [0.0, 0.0, 1.5]
    result = cleaned(moved(lively(300), offset))
    assert found(result) == [("cut", "root_jump")]
    assert (result.decisions[0].first, result.decisions[0].last) == (150, 152)


def test_a_root_that_goes_to_zero_for_a_while_is_cut_out():
    motion = moved(lively(300), np.array([3.0, 1.0, 0.0]))
    zero = motion.root_pos.copy()
    zero[100:200] = 0.0
    result = cleaned(motion.__class__(**{**vars(motion), "root_pos": zero}))
    assert ("drop", "zero_root") in found(result)
    assert [len(part.times_s) for part in result.parts] == [100, 100]


def test_a_body_that_turns_around_within_a_frame_is_cut_there():
    turn = np.where(np.arange(300) >= 150, np.pi, 0.0)
    result = cleaned(turned(lively(300), "root", "z", turn))
    assert [(d.reason, d.first) for d in result.decisions] == [("root_jump", 150)]


def test_a_body_that_spins_too_fast_for_some_frames_is_cut_out():
    turn = 2 * np.pi * np.clip((np.arange(600) - 300) / 12, 0.0, 1.0)
    result = cleaned(turned(lively(600, 120.0), "root", "y", turn))
    assert found(result) == [("cut", "root_jump")]
    assert 300 <= result.decisions[0].first and result.decisions[0].last <= 312


@pytest.mark.parametrize("speed", [3.0, 9.0])
def test_a_fast_run_is_no_jump(speed):
    assert found(cleaned(lively(300, 60.0, speed))) == []


def test_a_pirouette_is_no_jump():
    assert found(cleaned(turned(lively(300), "root", "z", np.arange(300) / 60 * 15.0))) == []


def test_a_motion_whose_root_never_moves_is_marked():
    motion = lively(200)
    still = motion.__class__(**{**vars(motion), "root_pos": figure(200).root_pos})
    result = cleaned(still)
    assert found(result) == [("mark", "in_place")] and result.marks == ("in_place",)
