"""Tests for rest_poses.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import arms_out, cleaned, figure, found, joined, lively, turned
from unicon.motion.cleaning.body_paths import body_paths
from unicon.motion.cleaning.rest_poses import arms_out as are_arms_out


def test_arms_are_out_only_when_straight_level_and_opposite():
    out = arms_out(1)
    assert are_arms_out(body_paths(out)).all()
    for joint, axis, angle in (
        ("left_elbow", "x", 0.6),
        ("right_shoulder", "x", 0.5),
        ("left_hip", "y", 0.6),
        ("left_knee", "y", 0.6),
    ):
        assert not are_arms_out(body_paths(turned(out, joint, axis, angle))).any()
    assert not are_arms_out(body_paths(figure(1))).any()


@pytest.mark.parametrize("count", [1, 2, 7])
def test_an_added_pose_is_cut_at_the_beginning(count):
    result = cleaned(joined(arms_out(count), lively(300)))
    (decision,) = result.decisions
    assert (decision.what, decision.reason, decision.first, decision.last) == (
        "cut",
        "rest_pose",
        0,
        count - 1,
    )
    assert "rad/s" in decision.text
    assert np.array_equal(result.parts[0].local_quat, lively(300).local_quat)


def test_an_added_pose_is_cut_at_the_end():
    result = cleaned(joined(lively(300), arms_out(2)))
    assert [(d.reason, d.first, d.last) for d in result.decisions] == [("rest_pose", 300, 301)]


def test_the_smeared_jump_after_an_added_pose_is_cut_too():
    smeared = lively(300)
    rest = np.array([1.0, 0.6, 0.3, 0.1])
    for side, sign in (("left", 1.0), ("right", -1.0)):
        smeared = turned(smeared, f"{side}_shoulder", "x", sign * rest * np.pi / 2, slice(0, 4))
    result = cleaned(joined(arms_out(1), smeared))
    assert found(result) == [("cut", "rest_pose")]
    assert 4 <= result.decisions[0].last <= 6


def test_a_pose_with_the_arms_out_that_someone_really_takes_is_kept():
    slow = 0.5 * np.pi * np.clip(1.0 - (np.arange(300) - 30) / 60, 0.0, 1.0)
    motion = turned(lively(300), "left_shoulder", "x", slow)
    motion = turned(motion, "right_shoulder", "x", -slow)
    assert found(cleaned(motion)) == []
