"""Tests for deepmimic.py, on files written here."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.deepmimic import read_deepmimic
from unicon.motion.formats.motion_file import MotionFile


def row(duration: float = 0.1, x: float = 0.0, turn: float = 0.0, knee: float = 0.0) -> list[float]:
    """One frame: x forward, turned about DeepMimic's y (up), right knee bent."""
    identity = [1.0, 0.0, 0.0, 0.0]
    root = [np.cos(turn / 2), 0.0, np.sin(turn / 2), 0.0]
    right_leg, left_leg = [*identity, knee, *identity], [*identity, 0.0, *identity]
    arm = [*identity, 0.3]
    return [duration, x, 0.9, 0.2, *root, *identity, *identity, *right_leg, *arm, *left_leg, *arm]


def write(path, frames, loop="none") -> MotionFile:
    path.write_text(json.dumps({"Loop": loop, "Frames": frames}))
    return MotionFile.from_path(path)


def test_axes_are_turned_to_z_up_and_y_left(tmp_path):
    motion = read_deepmimic(write(tmp_path / "humanoid3d_a.txt", [row(x=1.0, turn=0.5), row()], "wrap"))
    assert motion.name == "a"
    assert motion.family == ""
    assert motion.loop
    assert np.allclose(motion.root_pos[0], [1.0, -0.2, 0.9])
    heading = rotations.heading_angle(motion.local_quat[0, 0])
    assert np.isclose(heading, 0.5)


def test_times_are_the_sums_of_the_durations(tmp_path):
    motion = read_deepmimic(write(tmp_path / "a.txt", [row(0.1), row(0.3), row(0.2)]))
    assert np.allclose(motion.times_s, [0.0, 0.1, 0.4])


def test_a_bent_knee_takes_the_ankle_back(tmp_path):
    motion = read_deepmimic(write(tmp_path / "a.txt", [row(knee=-1.0), row()]))
    places = dict(zip(motion.joint_names, motion.global_positions()[0], strict=True))
    assert places["right_ankle"][0] < places["right_knee"][0] - 0.3
    assert np.isclose(places["left_ankle"][0], places["left_knee"][0])
    assert places["left_hip"][1] > places["right_hip"][1]


def test_rotations_agree_with_scipys_in_its_own_axes(tmp_path):
    quat = Rotation.from_euler("xyz", [0.3, -0.5, 0.8]).as_quat()
    frame = row()
    frame[4:8] = [quat[3], *quat[:3]]
    motion = read_deepmimic(write(tmp_path / "a.txt", [frame, row()]))
    there = Rotation.from_quat(quat).apply([0.1, 0.2, 0.3])
    here = rotations.rotate(motion.local_quat[0, 0], np.array([0.1, -0.3, 0.2]))
    assert np.allclose(here, [there[0], -there[2], there[1]])


@pytest.mark.parametrize(
    ("frames", "said"),
    [
        ([row(), row()[:43]], "frame 2 has 43 numbers"),
        ([row(), [*row()[:-1], None]], "frame 2 holds something"),
        ([row(0.0), row()], "frame 1 lasts 0"),
        ([row(), [*row()[:-1], "x"]], "frame 2 holds something"),
        ([row(), [*row()[:-1], 10**400]], "frame 2 holds something"),
        (
            [row(), [*row()[:4], 0.0, 0.0, 0.0, 0.0, *row()[8:]]],
            "frame 2: the rotation of root has the length 0",
        ),
        ([row(), 7], "frame 2 has 0 numbers"),
        ([row()], "2 or more frames"),
    ],
)
def test_a_bad_frame_is_named(tmp_path, frames, said):
    with pytest.raises(InputFileError, match=said):
        read_deepmimic(write(tmp_path / "a.txt", frames))


def test_quaternions_that_are_not_quite_unit_ones_are_made_so(tmp_path):
    frame = row(turn=0.5)
    frame[4:8] = [1.1 * value for value in frame[4:8]]
    motion = read_deepmimic(write(tmp_path / "a.txt", [frame, row()]))
    assert np.isclose(np.linalg.norm(motion.local_quat[0, 0]), 1.0)
    assert np.isclose(rotations.heading_angle(motion.local_quat[0, 0]), 0.5)


@pytest.mark.parametrize("content", [b"", b'{"Frames": [[1, 2', b"\xff\xfe\x00binary", b"[1, 2]"])
def test_what_is_no_such_file_is_refused_by_name(tmp_path, content):
    path = tmp_path / "broken.txt"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match="broken.txt"):
        read_deepmimic(MotionFile.from_path(path))
