"""Tests for toes.py."""

from __future__ import annotations

import numpy as np

from tests.motion.gaits import pose, with_poses
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.solid_shapes import body_height
from unicon.motion.grounding.toes import bend_toes, highest_tips

LEFT, RIGHT = (HUMANOID.joint_names.index(f"{side}_toe") for side in ("left", "right"))


def on_its_balls(pitch: float, count: int = 20):
    """Stand on tiptoe, the balls on the floor."""
    frames = pose(count, left_ankle_y=pitch, right_ankle_y=pitch)
    lift = -body_height(forward_kinematics(frames), "left_foot")
    return with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(lift, [0.0, 0.0, 1.0]))


def test_toes_lie_flat_when_someone_stands_on_tiptoe():
    frames = on_its_balls(0.6)
    bent = with_poses(frames, joint_pos=bend_toes(frames.joint_pos, forward_kinematics(frames)))
    assert np.allclose(bent.joint_pos[:, [LEFT, RIGHT]], -0.6, atol=0.12)
    height = body_height(forward_kinematics(bent), "left_toe")
    assert np.all(height > -0.008)
    assert np.all(body_height(forward_kinematics(frames), "left_toe") < -0.03)


def test_toes_off_the_floor_are_left_alone():
    frames = on_its_balls(0.6)
    high = with_poses(frames, root_pos_w=frames.root_pos_w + np.array([0.0, 0.0, 0.1]))
    assert np.array_equal(bend_toes(high.joint_pos, forward_kinematics(high)), high.joint_pos)


def test_toes_come_back_without_a_snap():
    frames = on_its_balls(0.6, 60)
    rise = np.where(np.arange(60) < 30, 0.0, 0.2)
    jump = with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(rise, [0.0, 0.0, 1.0]))
    angle = bend_toes(jump.joint_pos, forward_kinematics(jump))[:, LEFT]
    assert angle[10] < -0.5
    assert abs(angle[-1]) < 0.05
    assert np.abs(np.diff(angle)).max() * 60 < 10.0


def test_the_highest_tip_of_a_flat_foot_is_its_length_above_the_hinge():
    # Bent by 80 degrees: 0.02 + 0.07 sin 80 - 0.02 cos 80.
    expected = 0.02 + 0.07 * np.sin(np.radians(80)) - 0.02 * np.cos(np.radians(80))
    assert np.allclose(highest_tips(forward_kinematics(pose())), expected, atol=1e-9)
