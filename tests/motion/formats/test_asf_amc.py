"""Tests for asf_amc.py, on a skeleton of three bones with values worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from unicon.errors import InputFileError
from unicon.motion.formats.asf_amc import rate_hz, read_amc
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

ASF = """# made by hand
:version 1.10
:name TEST
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name hip
    direction 0 -1 0
    length 2
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name thigh
    direction 0 -1 0
    length 4
    axis 0 0 90 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 3
    name shin
    direction 0 0 1
    length 3
    axis 0 0 0 XYZ
    dof rx
    limits (-10.0 170.0)
  end
:hierarchy
  begin
    root hip
    hip thigh
    thigh shin
  end
"""
AMC = """#!OML:ASF made by hand
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
thigh 90 0 0
shin 0
2
root 1 2 3 0 90 0
thigh 0 0 0
shin 90
"""


def read(tmp_path, amc=AMC, asf=ASF, name="take") -> SourceMotion:
    if asf is not None:
        (tmp_path / "take.asf").write_text(asf)
    (tmp_path / f"{name}.amc").write_text(amc)
    return read_amc(MotionFile.from_path(tmp_path / f"{name}.amc"))


def in_file_axes(vectors: np.ndarray) -> np.ndarray:
    return vectors[..., [1, 2, 0]]


def test_joints_are_where_their_bones_begin_in_the_files_unit(tmp_path):
    motion = read(tmp_path)
    assert motion.joint_names == ("root", "hip", "thigh", "shin")
    assert motion.parents.tolist() == [-1, 0, 1, 2]
    rest = [[0, 0, 0], [0, 0, 0], [0, -2, 0], [0, -6, 0]]
    assert np.allclose(in_file_axes(motion.rest_positions()), rest)
    assert np.allclose(in_file_axes(motion.root_pos), [[1, 2, 3], [1, 2, 3]])
    assert np.allclose(motion.times_s, [0, 1 / 120])
    assert (motion.name, motion.family) == ("take", "")


def test_a_bone_turns_about_the_axes_of_its_own_frame(tmp_path):
    """The thigh's frame is turned by 90 degrees about z, so that its x axis is the world's y axis."""
    motion = read(tmp_path)
    turn = Rotation.from_quat(motion.local_quat[0, 2], scalar_first=True)
    vector = in_file_axes(turn.apply([1.0, 0.0, 0.0]))  # z of the file, turned by 90 degrees about its y
    assert np.allclose(vector, [1, 0, 0])


def test_joints_are_where_they_are_by_hand(tmp_path):
    """In frame 2 the thigh's turn about z brings its bone from -y to x, which the root has turned to -z."""
    motion = read(tmp_path, AMC.replace("thigh 0 0 0", "thigh 0 0 90"))
    places = in_file_axes(motion.global_positions())
    assert np.allclose(places[0], [[1, 2, 3], [1, 2, 3], [1, 0, 3], [1, -4, 3]])
    assert np.allclose(places[1], [[1, 2, 3], [1, 2, 3], [1, 0, 3], [1, 0, -1]])


def test_frames_and_turns_of_several_angles_agree_with_scipy(tmp_path):
    asf = ASF.replace("axis 0 0 90 XYZ", "axis 20 -30 40 XYZ").replace(
        "orientation 0 0 0", "orientation 5 6 7"
    )
    amc = AMC.replace("thigh 90 0 0", "thigh 10 50 -70").replace("root 1 2 3 0 0 0", "root 1 2 3 11 12 13")
    motion = read(tmp_path, amc, asf)
    for joint, frame, turn in ((2, [20, -30, 40], [10, 50, -70]), (0, [5, 6, 7], [11, 12, 13])):
        outer = Rotation.from_euler("xyz", frame, degrees=True)
        theirs = (outer * Rotation.from_euler("xyz", turn, degrees=True) * outer.inv()).apply([0.1, 0.2, 0.3])
        ours = Rotation.from_quat(motion.local_quat[0, joint], scalar_first=True).apply([0.3, 0.1, 0.2])
        assert np.allclose(in_file_axes(ours), theirs)


def test_radians_and_another_order_of_the_root_are_understood(tmp_path):
    asf = ASF.replace("angle deg", "angle rad").replace("axis 0 0 90", f"axis 0 0 {np.pi / 2}")
    asf = asf.replace("order TX TY TZ RX RY RZ", "order RX RY RZ TX TY TZ")
    amc = AMC.replace(":DEGREES", ":RADIANS").replace("thigh 90", f"thigh {np.pi / 2}")
    amc = amc.replace("root 1 2 3 0 90 0", f"root 0 {np.pi / 2} 0 1 2 3").replace(
        "root 1 2 3 0 0 0", "root 0 0 0 1 2 3"
    )
    amc = amc.replace("shin 90", f"shin {np.pi / 2}")
    ours, plain = read(tmp_path, amc, asf), read(tmp_path)
    assert np.allclose(ours.global_positions(), plain.global_positions())
    assert np.allclose(ours.local_quat, plain.local_quat)


@pytest.mark.parametrize(
    ("name", "first_line", "expected"),
    [
        ("60_08", "", 60.0),
        ("060_8_again", "", 60.0),
        ("09_06", "", 120.0),
        ("HDM_dg_06-03_03_120", "", 120.0),
        ("6_01", "", 120.0),
        ("backflip", "#!OML:ASF G:\\acrobat\\Session 1\\acrobatwednesday.ASF", 60.0),
    ],
)
def test_the_rate_follows_from_the_subject(name, first_line, expected):
    assert rate_hz(name, first_line) == expected


def test_the_rate_is_used(tmp_path):
    assert np.isclose(read(tmp_path, name="88_01").times_s[1], 1 / 60)


def test_an_amc_without_skeleton_is_named(tmp_path):
    with pytest.raises(InputFileError, match=r"take.amc: has no skeleton"):
        read(tmp_path, asf=None)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("angle deg", "angle gon", "line 7: angle is 'gon'"),
        ("order TX TY TZ RX RY RZ", "order TX TY TZ", "line 9: order is 'TX TY TZ'"),
        (
            "direction 0 -1 0\n    length 2",
            "direction 0 -1\n    length 2",
            "line 17: direction of hip has 2 numbers",
        ),
        ("    length 2\n", "", "line 19: a bone without length"),
        ("length 4", "length four", "line 25: length of thigh holds something that is not a number"),
        ("axis 0 0 90 XYZ", "axis 0 0 90", "line 26: axis order is ''"),
        ("axis 0 0 90 XYZ", "axis 0 0 90 XYX", "line 26: axis order is 'xyx'"),
        ("dof rx\n", "dof rx l\n", "line 38: dof of shin is 'rx l'"),
        ("thigh shin", "thigh shin toe", "line 45: the hierarchy names 'toe'"),
        ("thigh shin", "thigh shin hip", "the hierarchy names 'hip' twice"),
        (ASF[ASF.index(":hierarchy") :], "", "no ':root' with an order, or no ':hierarchy'"),
    ],
)
def test_a_defect_of_the_skeleton_is_named_with_its_line(tmp_path, old, new, said):
    assert old in ASF
    with pytest.raises(InputFileError, match=f"take.asf, .*{said}"):
        read(tmp_path, asf=ASF.replace(old, new, 1))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("thigh 90 0 0", "thigh 90 0", "line 6: thigh has 2 numbers, expected 3"),
        ("thigh 90 0 0", "thigh 90 0 x", "line 6: thigh holds something that is not a number"),
        ("thigh 90 0 0", "thigh 90 0 inf", "line 6: thigh holds a number that is not finite"),
        ("thigh 90 0 0", "toe 90 0 0", "line 6: did not expect 'toe' in frame 1"),
        ("shin 0\n", "shin 0\nshin 0\n", "line 8: did not expect 'shin' in frame 1"),
        ("shin 0\n", "", "line 7: frame 1 has no 'shin'"),
        ("shin 90\n", "", "line 10: frame 2 has no 'shin'; the file is cut short"),
        ("\n2\n", "\n3\n", "line 8: frame 3 where frame 2 was expected; frames are missing"),
        (AMC[AMC.index("2\nroot") :], "", "line 7: ends with 1 frames"),
        (AMC, ":DEGREES\n", "ends with 0 frames"),
    ],
)
def test_a_defect_of_the_motion_is_named_with_its_line(tmp_path, old, new, said):
    assert old in AMC
    with pytest.raises(InputFileError, match=f"take.amc, .*{said}"):
        read(tmp_path, amc=AMC.replace(old, new, 1))


def test_an_empty_skeleton_is_named(tmp_path):
    with pytest.raises(InputFileError, match="take.asf"):
        read(tmp_path, asf="")
