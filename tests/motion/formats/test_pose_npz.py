"""Tests for pose_npz.py, on files written here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from unicon.errors import InputFileError
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.formats.pose_npz import read_poses

ARRAYS = {
    "rotation": np.tile(np.array([0, 0, 0, 1], np.float32), (3, 2, 1)),
    "root_translation": np.array([[0, 0, 1], [0.1, 0, 1], [0.2, 0, 1]], np.float32),
    "fps": np.array(20.0),
    "node_names": np.array(["base", "arm"]),
    "parent_indices": np.array([-1, 0]),
    "local_translation": np.array([[0, 0, 1], [0.5, 0, 0]], np.float32),
}


def write_poses(path, **changes) -> MotionFile:
    arrays = {name: value for name, value in {**ARRAYS, **changes}.items() if value is not None}
    np.savez(path, **arrays)
    return MotionFile.from_path(path)


def test_joints_are_where_scipy_puts_them(tmp_path):
    turns = Rotation.random(6, random_state=1)
    motion = read_poses(write_poses(tmp_path / "a.npz", rotation=1.02 * turns.as_quat().reshape(3, 2, 4)))
    base, arm = motion.global_positions()[1]
    assert np.allclose(base, [0.1, 0, 1])
    assert np.allclose(arm - base, turns[2].apply([0.5, 0, 0]))
    assert np.allclose(motion.local_quat[1, 1], turns[3].as_quat(scalar_first=True))
    assert np.allclose(motion.times_s, [0, 0.05, 0.1])
    assert motion.joint_names == ("base", "arm")
    assert (motion.name, motion.family) == ("a", "")


@pytest.mark.parametrize(("fps", "rate_hz"), [(29, 29.97), (30, 30.0), (60.0, 60.0), (29.86, 29.86)])
def test_a_rate_that_was_cut_to_an_integer_is_mended(tmp_path, fps, rate_hz):
    motion = read_poses(write_poses(tmp_path / "a.npz", fps=np.array(fps)))
    assert np.isclose(1.0 / motion.times_s[1], rate_hz)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"fps": None}, "has no array 'fps'"),
        ({"fps": np.array(0)}, "'fps' is 0, expected more than 0"),
        ({"rotation": ARRAYS["rotation"][:1]}, "has 1 frames, expected 2 or more"),
        ({"rotation": 0.1 * ARRAYS["rotation"]}, "'rotation' of joint 0 in frame 1 has the length 0.1"),
        (
            {"root_translation": np.zeros((2, 3))},
            r"'root_translation' has the shape \(2, 3\), expected 3 x 3",
        ),
        ({"node_names": np.array(["base"])}, r"'node_names' has the shape \(1,\), expected 2 names"),
        ({"parent_indices": np.array([1, -1])}, r"'parent_indices' is \[1, -1\], expected one root"),
        ({"parent_indices": np.array([-1, 1])}, r"'parent_indices' is \[-1, 1\]"),
    ],
)
def test_an_array_that_is_not_as_it_should_be_is_named(tmp_path, changes, said):
    with pytest.raises(InputFileError, match=f"a.npz: {said}"):
        read_poses(write_poses(tmp_path / "a.npz", **changes))
