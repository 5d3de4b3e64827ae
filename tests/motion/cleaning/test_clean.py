"""Tests for clean.py and workpiece.py: the steps together."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import (
    arms_out,
    chosen,
    cleaned,
    figure,
    found,
    joined,
    lively,
    moved,
    turned,
)
from unicon.errors import InputFileError
from unicon.motion.cleaning import Hints, Order, Overrides


@pytest.mark.parametrize("rate_hz", [24.0, 30.0, 60.0, 120.0])
def test_a_clean_motion_comes_out_as_it_went_in(rate_hz):
    motion = lively(int(6 * rate_hz), rate_hz)
    result = cleaned(motion)
    assert result.decisions == () and result.marks == ()
    (part,) = result.parts
    assert part.name == "take"
    assert np.array_equal(part.local_quat, motion.local_quat) and np.array_equal(
        part.root_pos, motion.root_pos
    )
    assert np.array_equal(part.times_s, motion.times_s)


@pytest.mark.parametrize("seed", range(5))
def test_noise_of_a_capture_is_no_defect(seed):
    random = np.random.default_rng(seed)
    motion = lively(600, 120.0)
    for joint in ("left_wrist", "right_ankle", "chest", "root"):
        motion = turned(motion, joint, "x", random.normal(0.0, 0.01, 600))
    motion = moved(motion, random.normal(0.0, 0.001, (600, 3)))
    assert cleaned(motion).decisions == ()


def test_a_somersault_is_no_defect():
    motion = lively(120)
    turn = 2 * np.pi * np.clip((np.arange(120) - 40) / 40, 0.0, 1.0)
    assert found(cleaned(turned(motion, "root", "y", turn))) == []


def test_a_handstand_is_no_defect_and_needs_no_prop():
    sway = np.outer(0.02 * np.sin(0.1 * np.arange(240)), [1.0, 0.0, 0.0])
    motion = moved(figure(240), np.array([0.0, 0.0, 0.2]) + sway)
    motion = turned(motion, "root", "y", np.pi + 0.02 * np.sin(0.1 * np.arange(240)))
    for side in ("left", "right"):
        motion = turned(motion, f"{side}_shoulder", "y", np.pi + 0.02 * np.sin(0.13 * np.arange(240)))
    assert found(cleaned(motion)) == []


def test_parts_between_cuts_are_named_in_order_and_begin_at_time_zero():
    motion = lively(300)
    jump = moved(motion, np.outer(np.arange(300) >= 100, [2.0, 0.0, 0.0]))
    jump = moved(jump, np.outer(np.arange(300) >= 200, [0.0, 3.0, 0.0]))
    result = cleaned(jump)
    assert [part.name for part in result.parts] == ["take", "take_b", "take_c"]
    assert [len(part.times_s) for part in result.parts] == [100, 100, 100]
    assert all(part.times_s[0] == 0.0 for part in result.parts)
    assert np.array_equal(result.parts[1].root_pos, jump.root_pos[100:200])


def test_a_part_shorter_than_half_a_second_is_dropped_and_said_so():
    motion = moved(lively(300), np.outer(np.arange(300) >= 280, [2.0, 0.0, 0.0]))
    result = cleaned(motion)
    assert found(result) == [("cut", "root_jump"), ("drop", "too_short")]
    assert result.decisions[1].text == "Only 0.32 s are left between cuts."
    assert (result.decisions[1].first, result.decisions[1].last) == (280, 299)
    assert len(result.parts) == 1 and len(result.parts[0].times_s) == 280


def test_a_short_clip_without_defects_is_kept():
    assert len(cleaned(lively(12)).parts) == 1


def test_a_motionless_file_is_dropped():
    result = cleaned(arms_out(100))
    assert found(result) == [("drop", "no_motion")] and result.parts == () and result.marks == ()


def test_decisions_count_frames_as_the_file_does_even_after_repeats_are_left_out():
    motion = moved(lively(300), np.outer(np.arange(300) >= 150, [2.0, 0.0, 0.0]))
    result = cleaned(chosen(motion, np.repeat(np.arange(300), 2)))
    assert found(result) == [("resample", "repeated_frames"), ("cut", "root_jump")]
    assert result.decisions[1].first == 300


def test_a_decision_reads_as_a_line_of_a_report():
    motion = moved(lively(300), np.outer(np.arange(300) >= 150, [2.0, 0.0, 0.0]))
    (decision,) = cleaned(motion).decisions
    assert str(decision).startswith("cut frame 150 (root_jump): The pelvis moves with up to 120.")


def test_a_dropped_clip_has_no_parts_and_the_reason_that_was_given():
    overrides = Overrides((Order(clips="take", reason="it is a joke", drop=True),))
    result = cleaned(lively(), overrides)
    assert result.parts == () and str(result.decisions[0]) == "drop frames 0-299 (by_hand): It is a joke."


def test_a_kept_clip_is_not_judged():
    motion = joined(arms_out(5), moved(lively(300), np.array([5.0, 0.0, 0.0])))
    overrides = Overrides((Order(clips="take", reason="it is meant so", keep=True),))
    result = cleaned(motion, overrides, description="sits on a chair")
    assert found(result) == [("keep", "by_hand")] and result.marks == ()
    assert len(result.parts[0].times_s) == 305


def test_cuts_rates_and_marks_given_by_hand_are_obeyed():
    order = Order(
        clips="*",
        reason="seen",
        cut=((0, 9), (100, 119)),
        rate_hz=30.0,
        mark=("prop",),
        unmark=("uneven_ground",),
    )
    result = cleaned(lively(300), Overrides((order,)), description="walk on uneven terrain")
    assert [len(part.times_s) for part in result.parts] == [90, 180]
    assert np.allclose(np.diff(result.parts[0].times_s), 1 / 30)
    assert result.marks == ("prop",)
    assert all(reason == "by_hand" for _, reason in found(result))


def test_a_reason_may_be_ignored():
    motion = joined(arms_out(5), lively(300))
    order = Order(clips="*", reason="the actor did that", ignore=("rest_pose",))
    assert ("cut", "rest_pose") in found(cleaned(motion))
    assert ("cut", "rest_pose") not in found(cleaned(motion, Overrides((order,))))


def test_an_unknown_family_is_refused():
    from dataclasses import replace

    from unicon.motion.cleaning import clean

    with pytest.raises(InputFileError, match="there is no mapping for skeletons 'martian'"):
        clean(replace(lively(), family="martian"), Hints(), Overrides())
