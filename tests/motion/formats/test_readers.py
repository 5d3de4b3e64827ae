"""Tests for readers.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.formats.test_bvh import FILE
from tests.motion.formats.test_deepmimic import row, write
from tests.motion.formats.test_joint_angles_npz import write_angles
from tests.motion.formats.test_pose_npz import write_poses
from unicon.errors import InputFileError
from unicon.motion.formats.motion_file import MotionFile, find_motion_files
from unicon.motion.formats.readers import read_motion


def test_each_kind_is_read_by_its_reader(tmp_path):
    (tmp_path / "a.BVH").write_text(FILE)
    write(tmp_path / "b.txt", [row(), row()])
    write(tmp_path / "c.json", [row(), row()])
    write_poses(tmp_path / "d.npz")
    write_angles(tmp_path / "e.npz")
    motions = {file.name: read_motion(file) for file in find_motion_files([tmp_path])}
    roots = {name: motion.joint_names[0] for name, motion in motions.items()}
    assert roots == {"a": "Hips", "b": "root", "c": "root", "d": "base", "e": "pelvis"}
    assert {motion.family for motion in motions.values()} == {""}


def test_arrays_of_another_kind_are_named(tmp_path):
    np.savez(tmp_path / "a.npz", weights=np.zeros(3))
    with pytest.raises(InputFileError, match="a.npz: holds the arrays weights, expected those of poses"):
        read_motion(MotionFile.from_path(tmp_path / "a.npz"))


def test_an_unknown_suffix_lists_the_known_ones(tmp_path):
    with pytest.raises(
        InputFileError, match=r"take.fbx: there is no reader for '.fbx' files, only for .amc, .bvh"
    ):
        read_motion(MotionFile.from_path(tmp_path / "take.fbx"))


def test_a_damaged_archive_is_named(tmp_path):
    (tmp_path / "a.zip").write_bytes(b"PK no archive")
    (file,) = find_motion_files([tmp_path])
    with pytest.raises(InputFileError, match="a.zip: is no whole zip archive"):
        read_motion(file)
