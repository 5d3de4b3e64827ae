"""Tests for limbs.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon import rotations
from unicon.motion.retargeting.limbs import LIMBS, bend_normal, solve_limb

LEFT_ARM, LEFT_LEG, *_ = LIMBS
Y = np.array([[0.0, 1.0, 0.0]])
ORIGIN = np.zeros((1, 3))


def row(*values):
    return np.array([values], dtype=float)


def test_the_lengths_are_those_of_the_humanoid():
    assert LEFT_ARM.lengths_m == pytest.approx((0.30, 0.26))
    assert LEFT_LEG.lengths_m == pytest.approx((0.425, 0.42))


def test_a_bent_limbs_normal_is_as_long_as_the_sine_of_its_bend():
    """A shin bent back by 30 degrees: the knee's axis points left."""
    normal = bend_normal(row(0, 0, 0), row(0, 0, -1), row(-0.5, 0, -1 - np.sqrt(0.75)), 1.0)
    assert normal == pytest.approx(row(0, 0.5, 0))


def test_a_straight_leg_hangs():
    pose = solve_limb(LEFT_LEG, ORIGIN, [ORIGIN, row(0, 0, -0.425), row(0, 0, -0.845)], Y)
    assert pose.hinge == pytest.approx([0.0], abs=1e-6)
    assert pose.upper_quat_w == pytest.approx(row(1, 0, 0, 0), abs=1e-6)


def test_a_knee_at_a_right_angle_is_one_of_ours():
    """Thigh straight down, shin straight back."""
    pose = solve_limb(LEFT_LEG, ORIGIN, [ORIGIN, row(0, 0, -0.425), row(-0.42, 0, -0.425)], Y)
    assert pose.hinge == pytest.approx([np.pi / 2], abs=0.01)
    down = rotations.rotate(pose.upper_quat_w, row(0, 0, -1))
    assert down == pytest.approx(row(0, 0, -1), abs=0.01)


def test_an_elbow_at_a_right_angle_bends_forward():
    pose = solve_limb(LEFT_ARM, ORIGIN, [ORIGIN, row(0, 0, -0.30), row(0.26, 0, -0.30)], Y)
    assert pose.hinge == pytest.approx([-np.pi / 2], abs=0.01)


def test_a_bent_hand_is_reached_from_another_shoulder():
    origin, goal = row(0.02, 0.03, 0.05), row(0.26, 0.0, -0.30)
    pose = solve_limb(LEFT_ARM, origin, [ORIGIN, row(0, 0, -0.30), goal], Y)
    forearm = rotations.multiply(pose.upper_quat_w, rotations.from_axis_angle(Y, pose.hinge))
    elbow = origin + rotations.rotate(pose.upper_quat_w, row(0, 0, -0.30))
    wrist = elbow + rotations.rotate(forearm, row(0, 0, -0.26))
    assert np.linalg.norm(wrist - goal) < 0.01


def test_a_straight_arm_stays_straight_when_its_hand_is_too_near_for_ours():
    joints = [ORIGIN, row(0, 0.25, 0), row(0, 0.45, 0)]
    assert solve_limb(LEFT_ARM, ORIGIN, joints, row(0, 0, 1)).hinge == pytest.approx([0.0], abs=1e-6)


def test_a_bent_arm_is_never_straight_when_its_hand_is_too_far_for_ours():
    joints = [ORIGIN, row(0, 0, -0.5), row(0.4, 0, -0.7)]
    assert solve_limb(LEFT_ARM, ORIGIN, joints, Y).hinge[0] < -0.4


def test_a_straight_limb_has_the_twist_of_the_source():
    joints = [ORIGIN, row(0, 0, -0.425), row(0, 0, -0.845)]
    pose = solve_limb(LEFT_LEG, ORIGIN, joints, row(-np.sin(0.3), np.cos(0.3), 0))
    assert rotations.to_rotation_vector(pose.upper_quat_w) == pytest.approx(row(0, 0, 0.3), abs=1e-6)


def test_a_limb_bent_a_little_the_wrong_way_keeps_its_axis():
    joints = [ORIGIN, row(0, 0, -0.425), row(0.04, 0, -0.843)]
    pose = solve_limb(LEFT_LEG, ORIGIN, joints, Y)
    assert rotations.rotate(pose.upper_quat_w, Y) == pytest.approx(Y, abs=1e-6)


def test_folding_and_stretching_is_smooth():
    angle = np.concatenate([np.linspace(2.5, 0, 100), np.linspace(0, 2.5, 100)])
    zero = np.zeros(200)
    middle = np.stack([zero, zero, zero - 0.28], axis=-1)
    end = middle + 0.25 * np.stack([np.sin(angle), zero, -np.cos(angle)], axis=-1)
    pose = solve_limb(
        LEFT_ARM, np.zeros((200, 3)) + 0.02, [np.zeros((200, 3)), middle, end], np.tile(Y, (200, 1))
    )
    assert np.abs(np.diff(pose.hinge)).max() < 3 * 2.5 / 99
