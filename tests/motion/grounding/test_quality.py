"""Tests for quality.py."""

from __future__ import annotations

import numpy as np

from tests.motion.gaits import jump, pose, walk, with_poses
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.quality import measure

STANDS = np.ones((60, 2), dtype=bool)
UP = np.array([0.0, 0.0, 1.0])


def raised(frames, by):
    return with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(np.broadcast_to(by, 60), UP))


def test_a_pose_that_stands_has_nothing_to_complain_of():
    quality = measure(pose(60), STANDS)
    assert np.isclose(quality.penetration_p99_mm, 0.0, atol=1e-6)
    assert quality.floating_share == 0.0
    assert np.isclose(quality.skate_mm_per_frame, 0.0, atol=1e-9)
    assert quality.limit_saturation == 0.0
    assert np.isclose(quality.height_m, 1.8)
    assert quality.max_body_ang_vel == 0.0
    assert np.isnan(quality.flight_acceleration)
    assert np.isnan(quality.stance_ratio)


def test_depth_and_floating_are_measured():
    assert np.isclose(measure(raised(pose(60), -0.03), STANDS).penetration_p99_mm, 30.0)
    third = np.where(np.arange(60) < 20, 0.08, 0.0)
    assert np.isclose(measure(raised(pose(60), third), STANDS).floating_share, 1 / 3)


def test_skating_is_the_way_of_the_contact_from_frame_to_frame():
    frames = pose(60)
    skating = with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(np.arange(60), [0.003, 0.004, 0.0]))
    assert np.isclose(measure(skating, STANDS).skate_mm_per_frame, 5.0)
    assert np.isnan(measure(skating, ~STANDS).skate_mm_per_frame)


def test_hinges_at_their_limits_are_counted():
    frames = pose(60)
    angles = frames.joint_pos.copy()
    angles[:30, 0] = HUMANOID.joint_upper[0] - np.radians(0.4)
    angles[:, 1] = HUMANOID.joint_lower[1]
    quality = measure(with_poses(frames, joint_pos=angles), STANDS)
    assert np.isclose(quality.limit_saturation, 1.5 / 35)


def test_the_error_is_the_distance_to_the_reference_about_the_hips():
    frames = pose(60)
    names = ("head", "left_hand")
    bodies = forward_kinematics(frames)
    hips = bodies.pos_w[:, [HUMANOID.body_names.index(f"{s}_thigh") for s in ("left", "right")]].mean(axis=1)
    reference = bodies.pos_w[:, [HUMANOID.body_names.index(n) for n in names]] - hips[:, None]
    reference[:, 0] += [0.03, 0.0, 0.04]
    moved = with_poses(frames, root_pos_w=frames.root_pos_w + np.array([5.0, 1.0, 0.0]))
    quality = measure(moved, STANDS, reference, names)
    assert np.isclose(quality.mean_error_mm, 25.0)
    assert np.isclose(quality.worst_error_mm, 50.0)


def test_a_jumps_acceleration_is_gravitys():
    frames, air = jump()
    quality = measure(frames, np.repeat(~air[:, None], 2, axis=1))
    assert np.isclose(quality.flight_acceleration, -9.81, atol=0.5)
    assert np.isclose(quality.flight_share, air.mean(), atol=0.03)


def test_a_walk_agrees_with_its_legs_and_its_ends_are_fast():
    frames, contact = walk()
    quality = measure(frames, contact)
    assert np.isclose(quality.stance_ratio, 1.0, atol=0.01)
    assert np.isclose(quality.end_speed_ratio, 1.0)


def test_a_slowed_end_shows():
    frames, contact = walk()
    path = frames.root_pos_w.copy()
    path[:3, 0] = path[3, 0] - np.array([3, 2, 1]) * 0.6 / 60
    assert np.isclose(measure(with_poses(frames, root_pos_w=path), contact).end_speed_ratio, 0.6)


def test_spins_and_hinge_speeds_are_in_radians_a_second():
    frames = pose(60)
    angles = frames.joint_pos.copy()
    angles[:, HUMANOID.joint_names.index("head_z")] = np.arange(60) * 0.02
    quality = measure(with_poses(frames, joint_pos=angles), STANDS)
    assert np.isclose(quality.max_body_ang_vel, 1.2)
    assert np.isclose(quality.max_joint_vel, 1.2)


def test_all_figures_are_numbers_by_name():
    figures = measure(pose(60), STANDS).to_dict()
    assert figures["height_m"] == measure(pose(60), STANDS).height_m
    assert all(isinstance(value, float) for value in figures.values())
