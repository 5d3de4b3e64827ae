"""Tests for rest_pose.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.figures import REST_POSES, figure, moving, pose
from unicon import rotations
from unicon.motion.retargeting.rest_pose import has_standing_rest, most_upright_frame, with_rest_pose
from unicon.motion.retargeting.skeletons import load_mapping


def parts_of(motion):
    return load_mapping("cmu_mb").present(motion)


def test_the_motion_stays_where_it_is_in_the_world():
    motion = figure(moving(20))
    axes = rotations.normalize(np.random.default_rng(1).normal(size=(len(motion.parents), 4)))
    other = with_rest_pose(motion, axes)
    assert np.allclose(other.global_positions(), motion.global_positions())
    turned = rotations.multiply(motion.global_rotations(), rotations.conjugate(axes))
    assert np.allclose(np.abs(np.sum(other.global_rotations() * turned, axis=-1)), 1.0)


def test_a_joint_is_where_the_rest_pose_has_it():
    """Arms out: the left wrist 0.19 + 0.30 + 0.26 m to the left, all at the height of the shoulders."""
    motion = figure(moving(5), REST_POSES["arms out"])
    wrist = motion.rest_positions()[motion.joint_names.index("LeftHand")]
    assert wrist == pytest.approx([0.0, 0.04 + 0.15 + 0.30 + 0.26, 0.10 + 0.14 + 0.24])


@pytest.mark.parametrize("name", REST_POSES)
def test_usual_rest_poses_stand(name):
    motion = figure(moving(5), REST_POSES[name])
    assert has_standing_rest(motion, parts_of(motion))


@pytest.mark.parametrize("rest", [pose(knee=1.2), pose(hip_y=-1.5), pose(abdomen_z=0.8, chest_z=0.4)])
def test_poses_with_bent_legs_or_a_twist_are_no_rest(rest):
    motion = figure(moving(5), rest)
    assert not has_standing_rest(motion, parts_of(motion))


def test_the_most_upright_frame_is_the_standing_one():
    state = moving(60)
    state.joint_pos[:40, 1] = 0.8
    motion = figure(state)
    assert most_upright_frame(motion, parts_of(motion)) >= 40
