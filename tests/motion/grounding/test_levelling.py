"""Tests for levelling.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.gaits import pose, with_poses
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.levelling import LevellingConfig, level_feet

CONFIG = LevellingConfig()


def tilt_after(contact=True, **angles):
    """Return roll and pitch of the left sole [rad] in the middle of a pose held for a second."""
    frames = pose(60, **angles)
    stands = np.full((60, 2), contact)
    level = level_feet(frames.joint_pos, Soles(forward_kinematics(frames)), stands, CONFIG)
    x, y, z = Soles(forward_kinematics(with_poses(frames, joint_pos=level))).up_b[30, 0]
    return np.arctan2(y, z), np.arctan2(x, z)


@pytest.mark.parametrize("roll", [-0.4, 0.2, 0.5])
def test_a_sole_on_its_edge_is_laid_flat(roll):
    assert np.allclose(tilt_after(left_ankle_x=roll), 0.0, atol=0.01)


def test_a_small_slope_lengthwise_is_taken_out():
    assert np.allclose(tilt_after(left_ankle_y=0.1), 0.0, atol=0.01)


def test_tiptoe_stays_tiptoe():
    assert np.isclose(tilt_after(left_ankle_y=0.6)[1], -0.6, atol=1e-6)


def test_a_foot_in_the_air_keeps_its_tilt():
    assert np.isclose(abs(tilt_after(contact=False, left_ankle_x=0.3)[0]), 0.3, atol=1e-6)


def test_the_change_comes_and_goes_smoothly():
    frames = pose(120, left_ankle_x=0.4)
    contact = np.zeros((120, 2), dtype=bool)
    contact[40:80] = True
    level = level_feet(frames.joint_pos, Soles(forward_kinematics(frames)), contact, CONFIG)
    assert np.abs(np.diff(level, axis=0)).max() * 60 < 3.0
