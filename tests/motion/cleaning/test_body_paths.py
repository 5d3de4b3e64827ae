"""Tests for body_paths.py."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.motion.cleaning.figures import NAMES, lively
from unicon import rotations
from unicon.motion.cleaning.body_paths import body_paths, turn_angles


def test_positions_and_rotations_are_those_of_the_motion():
    motion = lively(20)
    paths = body_paths(motion)
    assert np.allclose(paths.pos("left_foot"), motion.global_positions()[:, NAMES.index("left_ankle")])
    assert np.allclose(paths.quat("head"), motion.global_rotations()[:, NAMES.index("neck")])
    assert np.isclose(paths.leg_m, 0.83) and np.isclose(paths.rate_hz, 60.0)


def test_moving_places_of_joints_are_followed():
    motion = lively(20)
    place = np.tile(motion.offsets, (20, 1, 1))
    place[:, NAMES.index("left_knee"), 2] -= np.linspace(0.0, 0.1, 20)
    moving = motion.__class__(**{**vars(motion), "local_pos": place})
    paths = body_paths(moving)
    assert np.allclose(paths.pos("left_foot"), moving.global_positions()[:, NAMES.index("left_ankle")])


def test_speeds_are_by_the_times():
    paths = body_paths(lively(60, speed=2.0)).take(np.arange(0, 60, 2))
    assert np.isclose(np.linalg.norm(paths.speeds()[:, paths.parts["pelvis"]].mean()), 2.0, atol=0.02)
    assert paths.backwards().times_s[0] == 0.0
    assert np.allclose(paths.backwards().pos("pelvis")[0], paths.pos("pelvis")[-1])


@settings(max_examples=50)
@given(st.floats(1e-5, 3.1), st.sampled_from([1.0, -1.0]))
def test_the_angle_between_rotations_is_exact_whatever_their_sign(angle, sign):
    turn = rotations.from_axis_angle(np.array([0.6, 0.0, 0.8]), np.array([0.4, 0.4 + angle]))
    turn[1] *= sign
    assert np.isclose(turn_angles(turn)[0], angle, atol=1e-7)
