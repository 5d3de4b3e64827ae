"""Tests for leg_ik.py."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.motion.gaits import ankles, pose, with_poses
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.leg_ik import LONGEST_M, SIDES, STRAIGHT_RAD, leg_of, missing_reach, move_foot

centimetres = st.floats(-0.06, 0.06)


def bent(**angles):
    return pose(2, 0.1, **angles)


def moved(frames, side, offset):
    shift = np.tile(offset, (2, 1))
    return with_poses(frames, joint_pos=move_foot(frames.joint_pos, forward_kinematics(frames), side, shift))


def test_no_shift_changes_nothing():
    frames = bent(left_hip_x=0.3, left_hip_z=-0.2)
    assert np.array_equal(moved(frames, "left", [0.0, 0.0, 0.0]).joint_pos, frames.joint_pos)


@settings(max_examples=40, deadline=None)
@given(
    st.tuples(centimetres, centimetres, st.floats(0.01, 0.06)), st.sampled_from(SIDES), st.floats(-0.4, 0.4)
)
def test_the_ankle_goes_where_it_shall_and_the_sole_keeps_its_tilt(offset, side, turn):
    frames = bent(**{f"{side}_hip_z": turn, f"{side}_hip_x": 0.2 * turn})
    result = moved(frames, side, offset)
    foot = SIDES.index(side)
    assert np.allclose(ankles(result)[:, foot] - ankles(frames)[:, foot], offset, atol=1e-6)
    up = [forward_kinematics(f).rot_w[:, leg_of(side).foot, 2, 2] for f in (frames, result)]
    assert np.allclose(up[0], up[1], atol=5e-3)
    assert np.allclose(ankles(result)[:, 1 - foot], ankles(frames)[:, 1 - foot])


def test_a_leg_that_gets_a_little_longer_falls_hardly_short():
    frames = bent()
    result = moved(frames, "left", [0.0, 0.0, -0.03])
    assert np.allclose((ankles(result) - ankles(frames))[:, 0, 2], -0.03, atol=2e-4)


def test_a_leg_bends_by_the_law_of_cosines():
    # Hip to ankle 0.845 m if straight, here 0.1 m less: 0.745^2 = 0.425^2 + 0.42^2 + 2 (0.425) (0.42) cos k.
    knee = bent().joint_pos[0, leg_of("left").knee]
    assert np.isclose(np.cos(knee), (0.745**2 - 0.425**2 - 0.42**2) / (2 * 0.425 * 0.42), atol=2e-4)


def test_a_knee_is_never_straighter_than_allowed():
    frames = bent()
    for down in (0.1, 0.2, 1.0):
        knee = moved(frames, "right", [0.0, 0.0, -down]).joint_pos[:, leg_of("right").knee]
        assert np.all(knee >= STRAIGHT_RAD - 1e-9)


def test_a_knee_that_straightens_slows_down_before_it_is_straight():
    frames = pose(40, 0.05)
    shift = np.outer(np.linspace(0.0, -0.08, 40), [0.0, 0.0, 1.0])
    knee = move_foot(frames.joint_pos, forward_kinematics(frames), "left", shift)[:, leg_of("left").knee]
    speed = np.abs(np.diff(knee))
    assert np.all(np.diff(knee) <= 1e-9)
    assert speed[-1] < 0.4 * speed.max()


def test_angles_stay_within_their_limits():
    frames = bent(left_ankle_y=1.2)
    result = moved(frames, "left", [0.3, 0.2, 0.3])
    assert np.all(result.joint_pos <= HUMANOID.joint_upper + 1e-12)
    assert np.all(result.joint_pos >= HUMANOID.joint_lower - 1e-12)


def test_a_mirrored_shift_gives_mirrored_angles():
    frames = bent(left_hip_x=0.2, left_hip_z=0.3)
    left = moved(frames, "left", [0.03, 0.04, 0.02])
    right = moved(HUMANOID.mirror(frames), "right", [0.03, -0.04, 0.02])
    assert np.allclose(HUMANOID.mirror(left).joint_pos, right.joint_pos)


def test_what_a_leg_lacks_is_how_far_the_hip_must_sink():
    hip, ankle = np.array([[0.0, 0.0, LONGEST_M]]), np.zeros((1, 3))
    sink = missing_reach(hip, ankle, np.array([[0.0, 0.0, -0.02]]))
    assert np.allclose(sink, 0.02)
    assert np.allclose(missing_reach(hip - [[0.0, 0.0, 0.1]], ankle, np.array([[0.0, 0.0, -0.02]])), 0.0)
