"""Tests for euler.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from unicon import rotations
from unicon.motion.retargeting.euler import ankle_angles, hinge_angle, hinge_angles, wrap

WIDE = np.full(3, np.pi)


def turns(path, order):
    return rotations.xyzw_to_wxyz(Rotation.from_euler(order, path).as_quat())


@settings(max_examples=50)
@given(st.floats(-3, 3), st.floats(-0.9, 0.9), st.floats(-3, 3), st.sampled_from(["XYZ", "XZY", "YXZ"]))
def test_hinge_angles_give_the_rotation_back(x, y, z, order):
    quat = turns([[x, y, z]], order)
    again = turns(hinge_angles(quat, order, -WIDE, WIDE), order)
    assert abs(np.sum(again * quat)) > 1 - 1e-9


def test_hinge_angles_go_on_where_the_middle_one_passes_a_right_angle():
    path = np.stack([np.full(200, 0.3), np.linspace(0.0, 3.0, 200), np.full(200, -0.4)], axis=1)
    angles = hinge_angles(turns(path, "XZY"), "XZY", -WIDE, WIDE)
    assert np.allclose(angles, path, atol=0.01)


def test_a_path_keeps_to_the_limits_where_it_can():
    """The same turns with the middle angle near pi - 0.5, or with it near 0.5, half a turn off."""
    path = np.tile([0.4, np.pi - 0.5, -0.2], (20, 1))
    lower, upper = np.array([-np.pi, -1.5, -np.pi]), np.array([np.pi, 1.5, np.pi])
    angles = hinge_angles(turns(path, "XZY"), "XZY", lower, upper)
    assert angles[:, 1] == pytest.approx(0.5)


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.parametrize("order", ["XYZ", "XZY"])
def test_angles_do_not_race_near_the_right_angle(order):
    """The body passes it within 2 degrees; exact angles go half a turn there."""
    times = np.linspace(-1, 1, 121)
    start = turns([[0.0, np.pi / 2, 0.0]], order)
    way = np.stack([np.full(121, 0.03), 0 * times, 0 * times], axis=-1)
    third = {"XYZ": [0, 1.0, 0], "XZY": [0, 0, 1.0]}[order]
    quat = rotations.multiply(
        rotations.from_rotation_vector(way + 1.2 * times[:, None] * np.array(third)), start
    )
    exact = np.unwrap(Rotation.from_quat(rotations.wxyz_to_xyzw(quat)).as_euler(order), axis=0)
    angles = hinge_angles(quat, order, -2 * WIDE, 2 * WIDE)
    body = np.linalg.norm(
        rotations.to_rotation_vector(rotations.multiply(quat[1:], rotations.conjugate(quat[:-1]))), axis=-1
    ).max()
    assert np.abs(np.diff(exact, axis=0)).max() > 5 * body
    assert np.abs(np.diff(angles, axis=0)).max() < 4 * body
    error = rotations.angle(rotations.multiply(rotations.conjugate(quat), turns(angles, order)))
    assert error.max() < 0.1


def test_a_limb_gives_up_its_spin_rather_than_its_direction():
    """Spun 100 degrees beyond what its hinges allow; the direction of its z axis is kept."""
    lower, upper = np.array([-0.5, -0.4, -0.5]), np.array([0.5, 0.4, 0.5])
    quat = np.tile(turns([[0.2, 0.0, 0.3]], "XZY"), (40, 1))
    quat = rotations.multiply(quat, rotations.from_heading(np.full(40, 0.9)))
    axis = np.array([0.0, 0.0, 1.0])
    for may_spin, expected in ((True, 0.06), (False, 0.5)):
        angles = np.clip(hinge_angles(quat, "XZY", lower, upper, may_spin=may_spin), lower, upper)
        kept = rotations.rotate(turns(angles, "XZY"), axis)
        error = np.linalg.norm(kept - rotations.rotate(quat, axis), axis=-1).max()
        assert error < expected
    assert error > 0.1


def test_an_ankle_turns_the_sole_to_where_it_was():
    """Pitch 0.3, roll -0.2: a yaw after them changes nothing of the sole's normal."""
    quat = turns([[0.3, -0.2, 0.5]], "YXZ")
    assert ankle_angles(quat) == pytest.approx(np.array([[0.3, -0.2]]), abs=0.03)
    assert ankle_angles(turns([[0.3, 0.0, 0.5]], "YXZ")) == pytest.approx(np.array([[0.3, 0.0]]))


def test_the_twist_about_one_axis():
    quat = rotations.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array([0.7, -2.0]))
    assert hinge_angle(quat, 1) == pytest.approx([0.7, -2.0])
    assert hinge_angle(quat, 0) == pytest.approx([0.0, 0.0])


def test_angles_wrap_to_half_a_turn():
    assert wrap(np.array([3.5, -3.5, 0.1])) == pytest.approx([3.5 - 2 * np.pi, 2 * np.pi - 3.5, 0.1])
