"""Tests for retarget.py, euler.py and ground.py."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.motion.test_deepmimic import row, write
from tests.samples import swaying
from unicon import rotations
from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.deepmimic import read_deepmimic
from unicon.motion.euler import hinge_angles
from unicon.motion.ground import height_correction, lowest_point
from unicon.motion.retarget import load_mapping, resample, retarget


def walk_like(tmp_path, speed: float = 1.2, count: int = 30):
    """Legs swing, knees bend, the root moves on at a steady speed."""
    frames = []
    for k in range(count):
        frame = row(1 / 30, x=speed * k / 30, knee=-0.6 - 0.5 * np.sin(0.4 * k))
        frame[2] = 0.85
        swing = 0.4 * np.sin(0.4 * k)
        frame[16:20] = [np.cos(swing / 2), 0.0, 0.0, np.sin(swing / 2)]
        frame[30:34] = [np.cos(swing / 2), 0.0, 0.0, -np.sin(swing / 2)]
        frames.append(frame)
    return read_deepmimic(write(tmp_path / "walk.txt", frames))


@settings(max_examples=50)
@given(st.lists(st.floats(-3, 3), min_size=3, max_size=3), st.sampled_from(["XYZ", "XZY", "YXZ"]))
def test_hinge_angles_give_the_rotation_back(angles, order):
    quat = rotations.xyzw_to_wxyz(Rotation.from_euler(order, angles).as_quat())[None]
    again = Rotation.from_euler(order, hinge_angles(quat, order)[0]).as_quat()
    assert abs(again @ rotations.wxyz_to_xyzw(quat[0])) > 1 - 1e-9


def test_hinge_angles_never_jump_where_the_middle_one_passes_a_right_angle():
    path = np.stack([np.full(200, 0.3), np.linspace(0.0, 3.0, 200), np.full(200, -0.4)], axis=1)
    quat = rotations.xyzw_to_wxyz(Rotation.from_euler("XZY", path).as_quat())
    angles = hinge_angles(quat, "XZY")
    assert np.abs(np.diff(angles[:, 1])).max() < 0.05
    assert np.allclose(angles[-1], path[-1], atol=1e-6)


def test_a_resampled_motion_has_sixty_frames_a_second_and_its_own_ends(tmp_path):
    motion = walk_like(tmp_path)
    dense = resample(motion)
    assert np.allclose(np.diff(dense.times_s), 1 / 60)
    assert np.allclose(dense.root_pos[0], motion.root_pos[0])
    assert np.allclose(dense.root_pos[2::2], motion.root_pos[1 : 1 + len(dense.root_pos[2::2])])


def test_the_ends_of_a_clip_are_as_fast_as_its_middle(tmp_path):
    frames = retarget(walk_like(tmp_path)).frames
    speed = np.linalg.norm(frames.root_lin_vel_w[:, :2], axis=1)
    assert np.allclose(speed, speed[5], rtol=0.02)


def test_limbs_point_where_the_sources_do(tmp_path):
    motion = walk_like(tmp_path)
    clip = retarget(motion)
    source = resample(motion)
    theirs = source.global_positions()
    ours = forward_kinematics(clip.frames).pos_w
    for parent, child, a, b in (
        ("left_thigh", "left_shin", "left_hip", "left_knee"),
        ("right_shin", "right_foot", "right_knee", "right_ankle"),
        ("right_forearm", "right_hand", "right_elbow", "right_wrist"),
    ):
        i, j = HUMANOID.body_names.index(parent), HUMANOID.body_names.index(child)
        k, m = source.joint_names.index(a), source.joint_names.index(b)
        bone, other = ours[:, j] - ours[:, i], theirs[:, m] - theirs[:, k]
        cosine = (
            np.sum(bone * other, axis=-1) / np.linalg.norm(bone, axis=-1) / np.linalg.norm(other, axis=-1)
        )
        assert cosine.min() > 0.999


def test_the_lowest_point_is_on_the_floor_and_never_below(tmp_path):
    lowest = lowest_point(retarget(walk_like(tmp_path)).frames)
    assert lowest.min() > -0.005
    assert np.median(lowest) < 0.03


def test_angles_are_within_the_limits(tmp_path):
    angles = retarget(walk_like(tmp_path)).frames.joint_pos
    assert np.all(angles >= HUMANOID.joint_lower - 1e-12)
    assert np.all(angles <= HUMANOID.joint_upper + 1e-12)


def test_the_rest_pose_is_on_its_soles():
    assert np.allclose(lowest_point(swaying(3, speed=0.0)), 0.0, atol=1e-9)


def test_a_flight_stays_a_flight():
    times = np.arange(120) / 60
    height = np.maximum(0.0, 3.0 * (times - 0.7) - 0.5 * 9.81 * (times - 0.7) ** 2) * (times > 0.7)
    corrected = height + 0.3 + height_correction(height + 0.3)
    assert np.abs(corrected - height).max() < 0.03


def test_a_missing_joint_is_named(tmp_path):
    motion = walk_like(tmp_path)
    names = tuple("elbow" if name == "left_elbow" else name for name in motion.joint_names)
    with pytest.raises(InputFileError, match="left_elbow"):
        retarget(type(motion)(**{**vars(motion), "joint_names": names}))


def test_an_unknown_family_lists_those_there_are():
    with pytest.raises(InputFileError, match="cmu_mb, deepmimic"):
        load_mapping("none")


def test_a_motion_of_no_length_is_refused(tmp_path):
    path = tmp_path / "short.txt"
    path.write_text(json.dumps({"Frames": [row(0.001), row(0.001)]}))
    with pytest.raises(InputFileError, match="too short"):
        retarget(read_deepmimic(path))
