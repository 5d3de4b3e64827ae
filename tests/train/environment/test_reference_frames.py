"""Tests for reference_frames.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.small_library import make_library
from unicon.humanoid import HUMANOID
from unicon.target_frames import pack, unpack
from unicon.train.environment.dataset import DatasetConfig, choose_clips
from unicon.train.environment.reference_frames import ReferenceFrames


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    library = make_library(tmp_path_factory.mktemp("library"))
    return choose_clips(library, DatasetConfig(clips=("dance", "walk_a")))


def test_frames_are_those_of_the_data_set_s_clips(dataset):
    read = ReferenceFrames(dataset, (0, 3)).read(np.array([1, 0]), np.array([20, 5]), np.zeros(2, bool))
    assert read.shape == (2, 2, 83) and read.dtype == np.float32
    walk, dance = (dataset.library.get(name).frames for name in ("walk_a", "dance"))
    assert np.allclose(read[0], pack(walk[[20, 23]]), atol=1e-6)
    assert np.allclose(read[1], pack(dance[[5, 8]]), atol=1e-6)


def test_past_the_end_the_last_pose_is_held_at_rest(dataset):
    read = ReferenceFrames(dataset, (0, 5)).read(np.array([0]), np.array([58]), np.zeros(1, bool))
    held = unpack(read[0, 1])
    assert np.allclose(held.joint_pos, dataset.library.get("dance").frames.joint_pos[59], atol=1e-6)
    assert not np.any(held.joint_vel) and not np.any(held.root_lin_vel_w)


def test_only_what_is_mirrored_is_mirrored(dataset):
    places = np.array([1, 1]), np.array([20, 20])
    frames = ReferenceFrames(dataset, (0, 1))
    plain = frames.read(*places, np.zeros(2, bool))
    read = frames.read(*places, np.array([False, True]))
    assert np.array_equal(read[0], plain[0])
    assert np.allclose(read[1], pack(HUMANOID.mirror(unpack(plain[1]))), atol=1e-6)
    assert not np.allclose(read[1], plain[1], atol=1e-3)
