"""Tests for bvh.py, on files written here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.bvh import read_bvh

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


def read(tmp_path, text=FILE):
    path = tmp_path / "motion.bvh"
    path.write_text(text)
    return read_bvh(path, "test", 0.01)


def test_positions_are_metres_with_z_up_and_x_forward(tmp_path):
    motion = read(tmp_path)
    assert np.allclose(motion.root_pos, [[0.02, 0.01, 0.90], [0.04, 0.03, 0.91]])
    assert np.allclose(motion.offsets[1], [0.0, 0.0, 0.1])
    assert np.allclose(motion.times_s, [0.0, 0.04])


@pytest.mark.parametrize(("joint", "order", "angles"), [(0, "ZYX", [10, 20, 30]), (1, "YXZ", [40, 50, 60])])
def test_rotations_follow_the_order_of_the_channels(tmp_path, joint, order, angles):
    motion = read(tmp_path)
    theirs = Rotation.from_euler(order, angles, degrees=True).apply([0.1, 0.2, 0.3])
    ours = rotations.rotate(motion.local_quat[0, joint], np.array([0.3, 0.1, 0.2]))
    assert np.allclose(ours, theirs[[2, 0, 1]])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("HIERARCHY", "HELLO", "line 1: expected HIERARCHY"),
        ("OFFSET 0 10 0", "OFFSET 0 10", "line 8: OFFSET has 2 numbers"),
        ("CHANNELS 3", "CHANNELS 4", "line 9: CHANNELS 4"),
        ("Zrotation\n    End", "Wrotation\n    End", "line 9: CHANNELS"),
        ("Frames: 2", "Frames: many", "line 17: expected 'Frames: N'"),
        ("Frame Time: 0.04", "Frame Time: 0", "line 18"),
        ("40 50 60", "40 50", "line 19: frame 1 has 8 numbers, expected 9"),
        ("40 50 60", "40 50 x", "line 19: frame 1 holds something that is not a number"),
        ("40 50 60", "40 50 nan", "line 19: frame 1 holds a number that is not finite"),
        ("3 91 4 0 0 0 0 0 0\n", "", "ends after line 19, expected frame 2 of 2"),
        ("  }\n}\nMOTION", "  }\nMOTION", "did not expect 'MOTION'"),
    ],
)
def test_a_defect_is_named_with_its_line(tmp_path, old, new, said):
    assert old in FILE
    with pytest.raises(InputFileError, match=said):
        read(tmp_path, FILE.replace(old, new, 1))


@pytest.mark.parametrize("content", [b"", b"  \n", b"\x00\xff\xfe\x80"])
def test_an_empty_or_binary_file_is_named(tmp_path, content):
    path = tmp_path / "broken.bvh"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match="broken.bvh"):
        read_bvh(path, "test", 1.0)
