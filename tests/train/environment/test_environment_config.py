"""Tests for environment_config.py."""

from __future__ import annotations

import pytest

from unicon.errors import UniconError
from unicon.train.environment.environment_config import EnvironmentConfig


def test_a_control_step_is_one_or_two_frames():
    assert EnvironmentConfig(control_hz=60).frame_step == 1
    assert EnvironmentConfig(control_hz=30).frame_step == 2


@pytest.mark.parametrize(
    "wrong",
    [
        {"num_envs": 0},
        {"control_hz": 50},
        {"substeps": 0},
        {"rsis_frames": (10, 5)},
        {"rsis_share": 1.5},
        {"failure_cap": 0.5},
        {"joint_noise_rad": -0.1},
        {"episode_s": 0.0},
        {"observation": "tau-9"},
    ],
)
def test_what_is_out_of_range_is_refused(wrong):
    with pytest.raises(UniconError, match="expected"):
        EnvironmentConfig(**wrong)
