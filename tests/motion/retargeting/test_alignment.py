"""Tests for alignment.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.figures import REST_POSES, figure, moving
from unicon import rotations
from unicon.motion.retargeting.alignment import align, figure_frame
from unicon.motion.retargeting.skeletons import load_mapping


def parts_of(motion):
    return load_mapping("cmu_mb").present(motion)


def alignment_of(motion):
    parts, turns = parts_of(motion), motion.global_rotations()
    by_part = {part: turns[:, joint] for part, joint in parts.items()}
    return align(motion.rest_positions(), parts, motion.global_positions(), by_part)


def test_the_figures_frame_is_the_identity_where_it_faces_forward():
    motion = figure(moving(5), REST_POSES["arms out"])
    for foot in ("foot", "thigh"):
        turn = figure_frame(motion.rest_positions(), parts_of(motion), foot)
        assert np.abs(turn) == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-9)


def test_the_figures_frame_faces_where_it_faces():
    turn = rotations.from_heading(np.array(2.0))
    motion = figure(moving(5), REST_POSES["arms out"], turn=rotations.conjugate(turn))
    found = figure_frame(motion.rest_positions(), parts_of(motion), "foot")
    assert rotations.angle(rotations.multiply(found, turn)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("straight", [True, False])
def test_hinges_have_the_axes_of_anatomy_in_the_t_pose(straight):
    """Arms out with palms down: the left elbow bends forward about -z, so its y axis is up."""
    axes = alignment_of(figure(moving(60, straight=straight), REST_POSES["arms out"])).hinge_axes
    assert axes["left_upper_arm"] == pytest.approx([0.0, 0.0, 1.0], abs=0.02)
    assert axes["right_upper_arm"] == pytest.approx([0.0, 0.0, -1.0], abs=0.02)
    assert axes["left_thigh"] == pytest.approx([0.0, 1.0, 0.0], abs=0.02)


def test_feet_of_spread_legs_are_rolled_with_them():
    motion = figure(moving(5), REST_POSES["legs spread"])
    found = alignment_of(motion).feet["left"]
    expected = rotations.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(0.35))
    assert rotations.angle(rotations.multiply(rotations.conjugate(expected), found)) < 0.02
