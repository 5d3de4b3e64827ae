"""Tests for ground.py: whole motions, put on the ground."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.motion.gaits import PERIOD, ankles, jump, pose, walk, with_poses
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.ground import ground, height_correction, lowest_point
from unicon.motion.grounding.quality import measure
from unicon.motion.grounding.root_scale import scale_path
from unicon.motion.grounding.solid_shapes import mass_centre
from unicon.state import move

UP = np.array([0.0, 0.0, 1.0])


def raised(frames, by):
    height = np.broadcast_to(by, len(frames.root_pos_w))
    return with_poses(frames, root_pos_w=frames.root_pos_w + np.outer(height, UP))


def noisy_walk():
    """A walk as a capture has it: floor elsewhere and sloping, scaled path, feet that slip and tilt."""
    frames, _ = walk(150, 1.0)
    count = len(frames.root_pos_w)
    angles = frames.joint_pos + 0.02 * np.sin(np.outer(np.arange(count) / 7.0, np.linspace(0.5, 1.5, 35)))
    path = scale_path(frames.root_pos_w, 0.9) + np.outer(0.3 + np.linspace(0.0, 0.1, count), UP)
    return with_poses(frames, root_pos_w=path, joint_pos=angles)


def test_a_perfect_walk_is_left_as_it_is():
    frames, _ = walk()
    result = ground(frames)
    assert np.abs(result.frames.root_pos_w - frames.root_pos_w).max() < 0.01
    assert np.abs(result.frames.joint_pos - frames.joint_pos)[:, 7:].max() < 0.2
    assert np.isclose(result.root_scale, 1.0, atol=0.02)


@pytest.mark.parametrize("skate", [0.85, 1.2])
def test_a_skating_walk_gets_its_length_back_and_its_feet_rest(skate):
    frames, _ = walk()
    skating = with_poses(frames, root_pos_w=scale_path(frames.root_pos_w, skate))
    result = ground(skating)
    assert np.isclose(result.root_scale * skate, 1.0, atol=0.03)
    assert measure(result.frames, result.contact).skate_mm_per_frame < 0.5


def test_a_captured_walk_stands_on_the_floor_and_its_feet_rest():
    before = noisy_walk()
    result = ground(before)
    quality = measure(result.frames, result.contact)
    assert quality.skate_mm_per_frame < 1.0
    assert quality.penetration_p99_mm < 10.0
    assert quality.floating_share == 0.0
    assert result.contact.mean() > 0.45
    assert quality.max_joint_vel < 1.5 * np.abs(before.joint_vel).max() + 1.0


def test_the_ends_of_a_walk_are_as_fast_as_its_middle():
    frames = ground(noisy_walk()).frames
    speed = np.linalg.norm(frames.root_lin_vel_w[:, :2], axis=1)
    assert np.isclose(speed[0], speed[5], rtol=0.1)
    assert np.isclose(speed[-1], speed[-6], rtol=0.1)


def test_hinges_at_the_ends_are_as_fast_as_a_stride_further_in():
    frames = ground(walk(180).frames).frames
    hinge_speed = np.linalg.norm(frames.joint_vel, axis=1)
    assert np.isclose(hinge_speed[0], hinge_speed[PERIOD], rtol=0.1)
    assert np.isclose(hinge_speed[-1], hinge_speed[-1 - PERIOD], rtol=0.1)


@pytest.mark.parametrize("height", [-1.0, 0.4])
def test_a_motion_that_sinks_or_floats_comes_onto_the_floor(height):
    drift = height + 0.1 * np.sin(np.arange(180) / 30.0)
    lowest = lowest_point(ground(raised(walk(180).frames, drift)).frames)
    assert np.abs(lowest).max() < 0.012


@pytest.mark.parametrize("gravity", [8.5, 9.81])
def test_a_jump_falls_with_gravity_and_is_not_pulled_to_the_floor(gravity):
    frames, air = jump(gravity)
    result = ground(raised(frames, 0.5))
    inner = np.flatnonzero(result.air)[3:-3]
    height = mass_centre(forward_kinematics(result.frames))[:, 2]
    assert np.allclose((np.diff(height, 2) * 3600)[inner - 1], -9.81, atol=0.6)
    assert np.sum(result.air != air) <= 4
    assert lowest_point(result.frames).max() > 0.2
    assert not result.contact[result.air].any()


def test_a_slow_hand_made_jump_is_kept_rather_than_flattened_or_blown_up():
    frames, air = jump(gravity=3.5)
    height = lowest_point(ground(frames).frames)[air].max()
    assert 0.25 < height < 0.45


def test_a_body_that_lies_is_on_the_floor_by_its_back():
    lying = pose(90)
    quat = np.tile([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0], (90, 1))
    result = ground(with_poses(lying, root_quat_w=quat))
    assert np.allclose(lowest_point(result.frames), 0.0, atol=0.003)
    assert not result.contact.any()


@settings(max_examples=5, deadline=None)
@given(st.floats(-3, 3), st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-2, 2)))
def test_turning_and_shifting_the_world_changes_nothing(heading, offset):
    frames = noisy_walk()
    turned = move(frames, np.full(len(frames.root_pos_w), heading), np.array(offset))
    flat = np.array(offset) * np.array([1.0, 1.0, 0.0])
    expected = move(ground(frames).frames, np.full(len(frames.root_pos_w), heading), flat)
    found = ground(turned).frames
    assert np.allclose(found.root_pos_w, expected.root_pos_w, atol=1e-6)
    assert np.allclose(found.joint_pos, expected.joint_pos, atol=1e-5)


def test_mirrored_in_is_mirrored_out():
    frames = noisy_walk()
    straight, mirrored = ground(frames), ground(HUMANOID.mirror(frames))
    assert np.array_equal(straight.contact, mirrored.contact[:, ::-1])
    assert np.allclose(HUMANOID.mirror(straight.frames).joint_pos, mirrored.frames.joint_pos, atol=1e-6)
    assert np.allclose(HUMANOID.mirror(straight.frames).root_pos_w, mirrored.frames.root_pos_w, atol=1e-6)


def test_angles_stay_within_their_limits():
    angles = ground(noisy_walk()).frames.joint_pos
    assert np.all(angles >= HUMANOID.joint_lower - 1e-9)
    assert np.all(angles <= HUMANOID.joint_upper + 1e-9)


@pytest.mark.parametrize("count", [2, 3, 7, 12])
def test_short_clips_come_through(count):
    result = ground(raised(walk(count).frames, 0.2))
    assert np.isfinite(result.frames.joint_vel).all()
    assert np.abs(lowest_point(result.frames)).max() < 0.02


def test_the_input_is_not_changed():
    frames = noisy_walk()
    before = frames.root_pos_w.copy(), frames.joint_pos.copy()
    ground(frames)
    assert np.array_equal(frames.root_pos_w, before[0])
    assert np.array_equal(frames.joint_pos, before[1])


def test_a_planted_ankle_stays_in_its_place():
    result = ground(noisy_walk())
    middle = np.flatnonzero(result.contact[:, 0])[4:20]
    places = ankles(result.frames)[middle, 0, :2]
    assert np.ptp(places, axis=0).max() < 0.03


def test_a_height_correction_needs_only_the_lowest_points():
    times = np.arange(120) / 60 - 0.7
    height = np.maximum(0.0, 3.0 * times - 0.5 * 9.81 * times**2) * (times > 0.0)
    corrected = height + 0.3 + height_correction(height + 0.3)
    assert np.abs(corrected - height).max() < 0.03
