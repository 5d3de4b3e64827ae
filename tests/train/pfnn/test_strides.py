"""Tests for strides.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.train.pfnn.walking_samples import walker
from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.leg_ik import SIDES, leg_of
from unicon.train.pfnn.strides import face_aside, hold_foot_yaw, shorten
from unicon.train.pfnn.synthesis import bend, plant, sequence, turn_round

HIPS = [leg_of(side).hip[1] for side in SIDES]
FEET = [HUMANOID.body_names.index(f"{side}_foot") for side in SIDES]


def _foot_yaw(frames):
    rot_w = forward_kinematics(frames).rot_w[:, FEET]
    return np.unwrap(np.arctan2(rot_w[..., 1, 0], rot_w[..., 0, 0]), axis=0)


def test_feet_that_stand_do_not_turn_with_a_body_that_is_turned():
    stand = walker("stand", 2.0, speed=0.0, step=0.0).frames
    turn = 0.4 * np.sin(np.pi * np.arange(121) / 120)
    yaw = hold_foot_yaw(stand, turn)[:, HIPS]
    assert np.abs(yaw + turn[:, None] - (yaw + turn[:, None]).mean(axis=0)).max() < 0.1
    assert np.array_equal(hold_foot_yaw(stand, np.zeros(121)), stand.joint_pos)


def test_a_foot_swivels_less_in_a_bent_walk_than_its_body_turns():
    walk = plant(sequence([walker("walk", 5.0, speed=0.7).frames], [])).frames
    planted = plant(bend(walk, 1.4))
    yaw, heading = _foot_yaw(planted.frames), rotations.heading_angle(planted.frames.root_quat_w)
    both = planted.contact[1:] & planted.contact[:-1]
    swivel = np.abs(np.diff(yaw, axis=0))[both].mean()
    assert swivel < 0.6 * np.abs(np.diff(np.unwrap(heading))).mean()


def test_other_hinges_than_the_yaw_of_the_hips_are_left_alone():
    walk = walker("walk", 3.0).frames
    others = np.setdiff1d(np.arange(35), HIPS)
    held = hold_foot_yaw(walk, np.linspace(0.0, 2.0, 181))
    assert np.array_equal(held[:, others], walk.joint_pos[:, others])


@settings(max_examples=8, deadline=None)
@given(st.floats(0.1, 1.0))
def test_shorter_strides_go_so_much_less_far(share):
    walk = walker("walk", 5.0, speed=1.0).frames
    way = shorten(walk, share).root_pos_w[[60, -60], 0]
    assert way[1] - way[0] == pytest.approx(share * 181 / 60, rel=0.02)


def test_strides_of_full_length_are_those_of_the_walk():
    walk = walker("walk", 3.0).frames
    assert np.allclose(shorten(walk, 1.0).joint_pos, walk.joint_pos, atol=1e-12)
    assert np.allclose(shorten(walk, 1.0).root_pos_w, walk.root_pos_w, atol=1e-12)


def test_a_body_that_faces_aside_goes_the_same_way_on_the_same_feet():
    walk = walker("walk", 3.0, speed=1.0).frames
    aside = face_aside(walk, 0.5)
    assert np.array_equal(aside.root_pos_w, walk.root_pos_w)
    assert np.allclose(rotations.heading_angle(aside.root_quat_w), 0.5)
    assert np.allclose(_foot_yaw(aside), _foot_yaw(walk), atol=1e-6)


def test_steps_on_the_spot_turn_at_the_rate_but_for_their_ends():
    steps = shorten(walker("walk", 4.0, speed=0.7).frames, 0.1)
    heading = np.unwrap(rotations.heading_angle(turn_round(steps, 1.0).root_quat_w))
    # over 4 s at 1 rad/s, less half of each ramp of 0.4 s
    assert heading[-1] == pytest.approx(4.0 - 0.4, abs=0.02)
