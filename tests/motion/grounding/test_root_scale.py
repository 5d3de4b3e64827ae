"""Tests for root_scale.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.gaits import pose, walk, with_poses
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.root_scale import RootScaleConfig, scale_path, stance_ratio

CONFIG = RootScaleConfig()


def ratio_of(frames, contact):
    return stance_ratio(Soles(forward_kinematics(frames)), contact, frames.root_pos_w, CONFIG)


@pytest.mark.parametrize("skate", [0.8, 1.0, 1.25])
def test_the_ratio_of_a_walk_with_a_scaled_path_is_the_scales_inverse(skate):
    frames, contact = walk()
    skating = with_poses(frames, root_pos_w=scale_path(frames.root_pos_w, skate))
    assert np.isclose(ratio_of(skating, contact), 1.0 / skate, atol=0.01)


def test_standing_still_says_nothing():
    frames = pose(120)
    assert ratio_of(frames, np.ones((120, 2), dtype=bool)) is None


def test_feet_that_agree_with_the_root_only_half_of_the_time_say_nothing():
    frames, contact = walk()
    there_and_back = np.where(np.arange(180) < 90, 1.0, -1.0)
    path = np.outer(np.cumsum(there_and_back) / 60, [1.0, 0.0, 0.0]) + [0.0, 0.0, 0.85]
    assert ratio_of(with_poses(frames, root_pos_w=path), contact) is None


def test_a_path_is_scaled_about_its_start_and_keeps_its_height():
    path = np.array([[1.0, 2.0, 0.9], [2.0, 4.0, 1.0]])
    assert np.allclose(scale_path(path, 1.5), [[1.0, 2.0, 0.9], [2.5, 5.0, 1.0]])
