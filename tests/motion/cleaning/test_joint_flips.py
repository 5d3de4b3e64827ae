"""Tests for joint_flips.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import NAMES, cleaned, found, lively, turned
from unicon import rotations
from unicon.motion.cleaning.body_paths import body_paths, turn_angles


def largest_turn(motion, joint: str) -> float:
    return float(turn_angles(motion.local_quat[:, NAMES.index(joint)]).max())


@pytest.mark.parametrize("axis", ["x", "z"])
@pytest.mark.parametrize("frames", [1, 5, 30])
def test_a_hand_that_flips_and_comes_back_is_filled(axis, frames):
    motion = lively(300)
    flipped = turned(motion, "left_wrist", axis, np.pi, slice(150, 150 + frames))
    result = cleaned(flipped)
    (decision,) = result.decisions
    assert (decision.what, decision.reason) == ("repair", "joint_flip")
    assert 148 <= decision.first <= 150 and 149 + frames <= decision.last <= 151 + frames
    (part,) = result.parts
    assert np.allclose(np.abs(np.sum(part.local_quat * motion.local_quat, axis=-1)), 1.0, atol=1e-3)


def test_a_hand_that_flips_for_good_takes_a_few_frames_for_it():
    result = cleaned(turned(lively(300), "left_wrist", "x", np.pi - 0.1, slice(150, None)))
    assert found(result) == [("repair", "joint_flip")]
    assert len(result.parts) == 1 and largest_turn(result.parts[0], "left_wrist") < 0.6


def flipped_knee(frames: slice):
    """The left leg about its line from hip to ankle, as captures do it; the ankle stays."""
    motion = lively(300)
    paths = body_paths(motion)
    hip, ankle = paths.pos("left_thigh")[frames], paths.pos("left_foot")[frames]
    axis = (ankle - hip) / np.linalg.norm(ankle - hip, axis=-1, keepdims=True)
    swing = rotations.from_axis_angle(axis, np.full(len(axis), np.pi))
    thigh_w = rotations.multiply(swing, paths.quat("left_thigh")[frames])
    quat = motion.local_quat.copy()
    above = rotations.conjugate(paths.quat("pelvis")[frames])
    quat[frames, NAMES.index("left_hip")] = rotations.multiply(above, thigh_w)
    return motion, motion.__class__(**{**vars(motion), "local_quat": quat})


def test_a_flipped_knee_is_brought_back_and_the_ankle_stays():
    motion, flipped = flipped_knee(slice(140, 160))
    before, broken = body_paths(motion), body_paths(flipped)
    assert np.abs(broken.pos("left_shin") - before.pos("left_shin")).max() > 0.05
    result = cleaned(flipped)
    assert found(result)[0] == ("repair", "joint_flip")
    (part,) = result.parts
    after = body_paths(part)
    assert np.abs(after.pos("left_foot") - before.pos("left_foot")).max() < 1e-9
    assert np.abs(after.pos("left_shin") - before.pos("left_shin")).max() < 0.02
    assert np.allclose(part.local_quat[:138], motion.local_quat[:138])


def test_a_knee_that_does_not_come_back_breaks_the_motion():
    _, flipped = flipped_knee(slice(140, None))
    result = cleaned(flipped)
    assert ("cut", "joint_flip") in found(result)
    first, second = result.parts
    assert 136 <= len(first.times_s) <= 140 and 155 <= len(second.times_s) <= 160


@pytest.mark.parametrize("rate_hz", [30.0, 60.0, 120.0])
def test_a_punch_is_no_flip(rate_hz):
    count = int(4 * rate_hz)
    reach = 2.2 / (1.0 + np.exp(-40.0 * (np.arange(count) / rate_hz - 2.0)))
    motion = turned(lively(count, rate_hz), "left_elbow", "y", reach)
    assert found(cleaned(turned(motion, "left_shoulder", "y", -reach))) == []
