"""Tests for bvh.py, on files written here."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.motion import bvh_writing
from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

FILE = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
1 90 2 10 20 30 40 50 60
3 91 4 0 0 0 0 0 0
"""

MOVING = """HIERARCHY
ROOT Root
{
  OFFSET 0 0 0
  CHANNELS 3 Xrotation Yrotation Zrotation
  JOINT Hips
  {
    OFFSET 0 100 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -90 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 90 0 FIRST 0 0 0
0 90 0 SECOND 0 0 0
"""


def moving(first: str, second: str) -> str:
    """The root is turned by a right angle about y; the hips have these places."""
    return MOVING.replace("FIRST", first).replace("SECOND", second)


def read(tmp_path, text=FILE) -> SourceMotion:
    path = tmp_path / "motion.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_bvh(MotionFile.from_path(path))


def test_positions_keep_their_unit_with_z_up_and_x_forward(tmp_path):
    motion = read(tmp_path)
    assert (motion.name, motion.family) == ("motion", "")
    assert np.allclose(motion.root_pos, [[2, 1, 90], [4, 3, 91]])
    assert np.allclose(motion.offsets, [[0, 0, 0], [0, 0, 10]])
    assert np.allclose(motion.times_s, [0.0, 0.04])
    assert motion.joint_names == ("Hips", "Spine")


@pytest.mark.parametrize(("joint", "order", "angles"), [(0, "ZYX", [10, 20, 30]), (1, "YXZ", [40, 50, 60])])
def test_rotations_follow_the_order_of_the_channels(tmp_path, joint, order, angles):
    motion = read(tmp_path)
    theirs = Rotation.from_euler(order, angles, degrees=True).apply([0.1, 0.2, 0.3])
    ours = rotations.rotate(motion.local_quat[0, joint], np.array([0.3, 0.1, 0.2]))
    assert np.allclose(ours, theirs[[2, 0, 1]])


@settings(max_examples=60, deadline=None)
@given(bvh_writing.motions(), st.sampled_from(["\n", "\r\n", "\r"]), st.sampled_from(["  ", "\t", ""]))
def test_joints_are_where_plain_matrices_put_them(motion, newline, indent):
    with tempfile.TemporaryDirectory() as folder:
        ours = read(Path(folder), bvh_writing.write(motion, newline, indent))
    assert ours.joint_names == tuple(f"j{index}" for index in range(len(motion.joints)))
    theirs = bvh_writing.joint_positions(motion)
    rounded = any("position" in "".join(joint.channels) for joint in motion.joints[1:])
    extent = np.ptp(ours.rest_positions(), axis=0).max() * len(motion.joints)
    tolerance = 1e-9 + (0.002 * extent if rounded else 0.0)
    assert np.allclose(ours.global_positions(), theirs[..., [2, 0, 1]], rtol=1e-9, atol=tolerance)


def test_joints_are_where_another_reader_puts_them(tmp_path):
    bvh = pytest.importorskip("pymotion.io.bvh")
    skeleton = pytest.importorskip("pymotion.ops.skeleton")
    rng = np.random.default_rng(5)
    root = bvh_writing.Joint(
        -1, (0.0, 0.0, 0.0), ("Xposition", "Yposition", "Zposition", "Zrotation", "Xrotation", "Yrotation")
    )
    arms = ("Zrotation", "Yrotation", "Xrotation")
    joints = (
        root,
        *(bvh_writing.Joint(k - 1 if k != 3 else 0, (0.5 * k, 4.0, 1.0 - k), arms) for k in range(1, 5)),
    )
    motion = bvh_writing.Motion(joints, rng.uniform(-170, 170, (6, 18)))
    ours = read(tmp_path, bvh_writing.write(motion))
    other = bvh.BVH()
    other.load(str(tmp_path / "motion.bvh"))
    quat, pos, parents, offsets, *_ = other.get_data()
    theirs, _ = skeleton.fk(quat, pos[:, 0, :], offsets, parents)
    assert np.allclose(ours.global_positions(), theirs[..., [2, 0, 1]], atol=1e-3)


def test_joints_that_move_in_their_parents_frame_have_their_places_over_time(tmp_path):
    motion = read(tmp_path, moving("0 100 0", "10 100 0"))
    assert np.allclose(motion.local_pos, [[[0, 0, 0], [0, 0, 100]], [[0, 0, 0], [0, 10, 100]]])
    assert np.allclose(motion.global_positions()[1, 1], [-10, 0, 100])


@pytest.mark.parametrize("places", ["0 100 0", "0.0 100.01 -0.02", "0 0 0"])
def test_positions_that_repeat_the_offset_or_are_all_zero_are_no_movement(tmp_path, places):
    motion = read(tmp_path, moving(places, places))
    assert motion.local_pos is None
    assert np.allclose(motion.offsets[1], [0, 0, 100])


def test_positions_that_stay_elsewhere_become_the_offset(tmp_path):
    motion = read(tmp_path, moving("0 80 0", "0 80 0"))
    assert motion.local_pos is None
    assert np.allclose(motion.offsets[1], [0, 0, 80])


def test_a_root_without_position_channels_stays_at_its_offset(tmp_path):
    text = moving("0 100 0", "0 100 0").replace("OFFSET 0 0 0", "OFFSET 1 2 3", 1)
    assert np.allclose(read(tmp_path, text).root_pos, [[3, 1, 2], [3, 1, 2]])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("\n", "\r\n"),
        ("\n", "\n\n \t\n"),
        (" ", "\t"),
        ("ROOT Hips\n{", "ROOT Hips {"),
        ("HIERARCHY", "\ufeffhierarchy"),
        ("Xposition", "XPOSITION"),
        ("Frames: 2", "Frames:2"),
        ("Frames: 2", "FRAMES 2"),
        ("Frame Time: 0.04", "Frame Time:\t4.0e-2"),
        ("Frame Time: 0.04", "FrameTime 0.04"),
        ("40 50 60", "4e1 5.0E+1 +60."),
        ("0 0 0 0 0 0\n", "0 0 0 0 0 0"),
        ("0 0 0 0 0 0\n", "0 0 0 0 0 0\n7 7 7 7 7 7 7 7 7\n"),
        ("0 0 0 0 0 0\n", "0 0 0 0 0 0\n7 7 7"),
    ],
)
def test_harmless_variants_read_the_same(tmp_path, old, new):
    assert old in FILE
    ours, plain = read(tmp_path, FILE.replace(old, new)), read(tmp_path)
    assert ours.joint_names == plain.joint_names
    for name in ("times_s", "root_pos", "offsets", "local_quat"):
        assert np.allclose(getattr(ours, name), getattr(plain, name)), name


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("HIERARCHY", "HELLO", "line 1: expected HIERARCHY"),
        ("OFFSET 0 10 0", "OFFSET 0 10", "line 8: OFFSET has 2 numbers"),
        ("CHANNELS 3", "CHANNELS 4", "line 9: CHANNELS 4"),
        ("Zrotation\n    End", "Wrotation\n    End", "line 9: CHANNELS"),
        ("3 Yrotation", "3 Xrotation", "line 9: CHANNELS"),
        (
            "  JOINT Spine",
            "  CHANNELS 1 Xrotation\n  JOINT Spine",
            "line 6: did not expect 'CHANNELS 1 Xrotation'",
        ),
        ("  JOINT Spine", "  ROOT Spine", "line 6: a second ROOT"),
        ("ROOT Hips", "ROOT", "line 2: did not expect 'ROOT'"),
        ("Frames: 2", "Frames: many", "line 17: expected 'Frames: N'"),
        ("Frames: 2", "Frames: 1", "1 frames of 0.04 s are no motion"),
        ("Frame Time: 0.04", "Frame Time: 0", "line 18"),
        ("Frame Time: 0.04", "Frame Time: 0,04", "line 18: Frame Time holds something that is not a number"),
        ("Frame Time: 0.04\n", "", "line 18: expected 'Frame Time: seconds'"),
        ("40 50 60", "40 50", "line 19: frame 1 has 8 numbers, expected 9"),
        ("40 50 60", "40 50 60 70", "line 19: frame 1 has 10 numbers, expected 9"),
        ("40 50 60", "40 50 x", "line 19: frame 1 holds something that is not a number"),
        ("40 50 60", "40 50 nan", "line 19: frame 1 holds a number that is not finite"),
        ("4 0 0 0 0 0 0", "4 0 0 1e999 0 0 0", "line 20: frame 2 holds a number that is not finite"),
        ("4 0 0 0 0 0 0\n", "4 0 0\n", "line 20: frame 2 has 5 numbers, expected 9"),
        ("3 91 4 0 0 0 0 0 0\n", "", "ends after line 19, expected frame 2 of 2"),
        ("3 91 4 0 0 0 0 0 0\n", "\n  \n", "ends after line 19, expected frame 2 of 2"),
        ("  }\n}\nMOTION", "  }\nMOTION", "did not expect 'MOTION'"),
        (FILE[FILE.index("MOTION") :], "", "ends after line 15, expected the skeleton's end and MOTION"),
    ],
)
def test_a_defect_is_named_with_its_line(tmp_path, old, new, said):
    assert old in FILE
    with pytest.raises(InputFileError, match=f"motion.bvh.*{said}"):
        read(tmp_path, FILE.replace(old, new, 1))


def test_a_number_that_only_python_would_read_is_refused(tmp_path):
    with pytest.raises(InputFileError, match="motion.bvh, line 20: up to here the frames cannot be read"):
        read(tmp_path, FILE.replace("40 50 60", "40 50 6_0"))


@pytest.mark.parametrize("content", [b"", b"  \n", b"\x00\xff\xfe\x80"])
def test_an_empty_or_binary_file_is_named(tmp_path, content):
    with pytest.raises(InputFileError, match="motion.bvh"):
        read(tmp_path, content)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputFileError, match=r"none\.bvh: cannot be read"):
        read_bvh(MotionFile.from_path(tmp_path / "none.bvh"))
