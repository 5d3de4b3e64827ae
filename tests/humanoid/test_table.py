"""Tests for the humanoid's table and its arrays: each number of the specification."""

from __future__ import annotations

import numpy as np
import pytest

from tests.test_state import assert_same, random_state
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.table import BODIES, HINGES


def test_there_are_twenty_bodies_and_thirty_five_hinges():
    assert (len(HUMANOID.body_names), len(HUMANOID.joint_names)) == (20, 35)
    assert len(set(HUMANOID.joint_names)) == 35


def test_it_weighs_seventy_kilograms():
    assert np.isclose(HUMANOID.body_mass.sum(), 70.0)


def test_efforts_are_within_the_papers_range():
    assert HUMANOID.effort.min() == 50
    assert HUMANOID.effort.max() == 600


def test_parents_come_before_their_children():
    assert all(parent < body for body, parent in enumerate(HUMANOID.parents))


def test_the_left_side_is_the_mirror_image_of_the_right():
    by_name = {body.name: body for body in BODIES}
    for name, left in by_name.items():
        if not name.startswith("left_"):
            continue
        right = by_name[name.replace("left_", "right_")]
        assert left.mass == right.mass
        assert np.allclose(np.array(left.offset) * [1, -1, 1], right.offset)
        for a, b in zip(left.hinges, right.hinges, strict=True):
            assert (a.axis, a.effort, a.stiffness, a.damping) == (b.axis, b.effort, b.stiffness, b.damping)
            mirrored = (a.lower_rad, a.upper_rad) if a.axis[1] else (-a.upper_rad, -a.lower_rad)
            assert (b.lower_rad, b.upper_rad) == mirrored


def test_what_lies_on_the_middle_plane_is_symmetric_itself():
    for hinge in HINGES:
        if "_" in hinge.name and hinge.name.split("_")[0] not in ("left", "right") and not hinge.axis[1]:
            assert hinge.lower_rad == -hinge.upper_rad


def test_mirroring_twice_is_the_identity():
    state = random_state(0, 3)
    assert_same(HUMANOID.mirror(HUMANOID.mirror(state)), state)


def test_bodies_of_a_mirrored_state_are_mirrored():
    state = random_state(1)
    here, there = forward_kinematics(state), forward_kinematics(HUMANOID.mirror(state))
    swap = {"left": "right", "right": "left"}
    other = []
    for name in HUMANOID.body_names:
        side, *rest = name.split("_")
        other.append(HUMANOID.body_names.index("_".join([swap.get(side, side), *rest])))
    flip = np.array([1.0, -1.0, 1.0])
    assert np.allclose(there.pos_w[other], here.pos_w * flip)
    assert np.allclose(there.lin_vel_w[other], here.lin_vel_w * flip)
    assert np.allclose(there.ang_vel_w[other], here.ang_vel_w * -flip)


def test_the_arrays_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        HUMANOID.effort[0] = 1.0
