"""Tests for reset_states.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying
from unicon.target_frames import pack, unpack
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.reset_states import add_noise, choose_frames

RNG = np.random.default_rng


def test_the_start_is_the_state_of_a_frame_five_to_ten_away():
    frames = np.full(20_000, 100)
    chosen = choose_frames(frames, np.full(20_000, 200), EnvironmentConfig(rsis_share=1.0), RNG(0))
    distances, counts = np.unique(chosen - frames, return_counts=True)
    assert distances.tolist() == [*range(-10, -4), *range(5, 11)]
    assert np.allclose(counts, 20_000 / 12, atol=200)


def test_a_share_of_the_starts_is_in_the_state_of_their_own_frame():
    frames = np.full(20_000, 100)
    chosen = choose_frames(frames, np.full(20_000, 200), EnvironmentConfig(rsis_share=0.3), RNG(1))
    assert np.mean(chosen != frames) == pytest.approx(0.3, abs=0.015)


def test_at_the_ends_of_a_clip_the_frame_lies_on_the_side_that_has_it():
    config = EnvironmentConfig(rsis_share=1.0)
    first = choose_frames(np.zeros(500, np.int64), np.full(500, 90), config, RNG(2))
    last = choose_frames(np.full(500, 90), np.full(500, 90), config, RNG(3))
    assert first.min() == 5 and first.max() == 10
    assert last.min() == 80 and last.max() == 85


def test_in_a_clip_that_is_too_short_no_frame_beyond_it_is_chosen():
    chosen = choose_frames(np.full(200, 2), np.full(200, 4), EnvironmentConfig(rsis_share=1.0), RNG(4))
    assert chosen.min() >= 0 and chosen.max() <= 4


def test_noise_stays_within_its_bounds_and_reaches_them():
    config = EnvironmentConfig(
        position_noise_m=0.04, height_noise_m=0.01, joint_noise_rad=0.08, velocity_noise=0.25
    )
    rows = np.repeat(pack(swaying(1)).astype(np.float32), 3000, axis=0)
    unpack(rows).joint_vel[:, 0], unpack(rows).joint_vel[:, 1] = 0.0, 5.0
    change = unpack(add_noise(rows, config, RNG(5)) - rows)
    reach = [
        (change.root_pos_w[:, 0], -0.04, 0.04),
        (change.root_pos_w[:, 1], -0.04, 0.04),
        (change.root_pos_w[:, 2], 0.0, 0.01),
        (change.joint_pos[:, 7], -0.08, 0.08),
        (change.joint_vel[:, 0], -0.25 * 0.3, 0.25 * 0.3),
        (change.joint_vel[:, 1], -0.25, 0.25),
    ]
    for values, low, high in reach:
        slack = 0.01 * (high - low)
        assert low - 1e-5 <= values.min() <= low + slack
        assert high - slack <= values.max() <= high + 1e-5
    assert np.all(change.root_quat_w == 0.0)


def test_without_noise_the_states_stay_as_they_are():
    quiet = EnvironmentConfig(position_noise_m=0, height_noise_m=0, joint_noise_rad=0, velocity_noise=0)
    rows = pack(swaying(5)).astype(np.float32)
    assert np.array_equal(add_noise(rows, quiet, RNG(6)), rows)
