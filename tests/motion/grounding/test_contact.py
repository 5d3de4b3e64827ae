"""Tests for contact.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.gaits import PERIOD, STANCE, pose, walk, with_poses
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.contact import ContactConfig, Soles, find_contacts

CONFIG = ContactConfig()


def contacts_of(frames):
    return find_contacts(Soles(forward_kinematics(frames)), frames.root_pos_w, CONFIG)


def test_heel_and_ball_of_the_rest_pose_are_on_the_floor():
    soles = Soles(forward_kinematics(pose()))
    assert np.allclose(soles.points_w[0, 0], [[-0.065, 0.095, 0.0], [0.135, 0.095, 0.0]], atol=1e-9)
    assert np.allclose(soles.weights, 0.5)
    assert np.allclose(soles.heights, 0.0, atol=1e-9)


def test_a_lifted_heel_leaves_all_weight_on_the_ball():
    soles = Soles(forward_kinematics(pose(left_ankle_y=0.4)))
    assert np.allclose(soles.weights[0, 0], [0.0, 1.0])
    assert np.allclose(soles.weights[0, 1], 0.5)


def test_the_height_of_a_foot_on_its_edge_is_that_of_the_edge():
    height = Soles(forward_kinematics(pose(left_ankle_x=0.3))).heights[0, 0]
    assert np.isclose(height, 0.075 - 0.075 * np.cos(0.3) - 0.045 * np.sin(0.3), atol=1e-9)


def test_a_foot_that_rolls_over_its_ball_makes_no_step():
    frames = pose(30)
    pitch = np.linspace(0.2, 0.5, 30)
    angles = frames.joint_pos.copy()
    angles[:, HUMANOID.joint_names.index("left_ankle_y")] = pitch
    ankle_to_ball = np.array([0.135, -0.075])
    turned = np.stack(
        [
            np.cos(pitch) * ankle_to_ball[0] + np.sin(pitch) * ankle_to_ball[1],
            np.cos(pitch) * ankle_to_ball[1] - np.sin(pitch) * ankle_to_ball[0],
        ],
        axis=-1,
    )
    root = frames.root_pos_w + np.stack([-turned[:, 0], np.zeros(30), -turned[:, 1]], axis=-1)
    soles = Soles(forward_kinematics(with_poses(frames, joint_pos=angles, root_pos_w=root)))
    assert np.allclose(soles.steps_w()[:, 0], 0.0, atol=1e-12)


@pytest.mark.parametrize("speed", [0.5, 1.0, 1.4])
def test_contacts_of_a_walk_are_found_to_within_a_few_frames(speed):
    frames, exact = walk(180, speed)
    found = contacts_of(frames)
    assert np.mean(found != exact) < 0.12
    inner = np.arange(180) % PERIOD
    assert np.all(found[(inner > 2) & (inner < STANCE - 2), 0])
    assert not found[(inner > STANCE + 7) & (inner < PERIOD - 7), 0].any()


def test_a_foot_high_above_the_floor_doesnt_stand():
    frames = pose(60)
    lifted = with_poses(frames, root_pos_w=frames.root_pos_w + np.array([0.0, 0.0, 0.1]))
    assert not contacts_of(lifted).any()


def test_a_foot_that_glides_low_and_fast_doesnt_stand():
    frames = pose(60)
    drift = np.outer(np.arange(60) * 2.0 / 60, [1.0, 0.0, 0.0])
    assert not contacts_of(with_poses(frames, root_pos_w=frames.root_pos_w + drift)).any()


def test_a_contact_lasts_through_a_moment_above_the_first_threshold():
    frames = pose(60)
    lift = np.where((np.arange(60) > 20) & (np.arange(60) < 40), 0.04, 0.0)
    lift = np.convolve(np.pad(lift, 5, mode="edge"), np.ones(11) / 11, mode="valid")
    moved = with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(lift, [0.0, 0.0, 1.0]))
    assert contacts_of(moved).all()
    higher = with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(2 * lift, [0.0, 0.0, 1.0]))
    assert not contacts_of(higher).all()
