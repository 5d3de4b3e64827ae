"""Tests for clip.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying_clip
from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.clip import load_clip, repeat


def test_a_clip_comes_back_from_its_file(tmp_path):
    clip = swaying_clip()
    clip.save(tmp_path / "sway.npz")
    again = load_clip(tmp_path / "sway.npz")
    assert (again.name, again.label, len(again)) == ("sway", "test", 90)
    assert np.allclose(again.frames.joint_vel, clip.frames.joint_vel)


def test_a_clip_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        swaying_clip().frames.joint_pos[0, 0] = 1.0


def test_a_repeated_clip_goes_on_where_it_ended():
    clip = swaying_clip(61, speed=1.0)
    long = repeat(clip, 3)
    assert len(long) == 181
    assert np.allclose(long.frames.root_pos_w[-1, 0], 3.0)
    steps = np.diff(long.frames.root_pos_w[:, 0])
    assert np.allclose(steps, 1 / 60)


def test_a_clip_that_turns_goes_on_turning_when_repeated():
    clip = swaying_clip(31)
    quat = rotations.from_heading(np.linspace(0.0, 1.0, 31))
    from unicon.motion.clip import clip_from_poses

    turning = clip_from_poses("turn", clip.frames.root_pos_w, quat, clip.frames.joint_pos)
    last = repeat(turning, 2).frames.root_quat_w[-1]
    assert np.isclose(rotations.heading_angle(last), 2.0)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut short", b"plain text"])
def test_a_file_that_is_no_clip_is_named(tmp_path, content):
    path = tmp_path / "broken.npz"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match="broken.npz"):
        load_clip(path)


def test_a_clip_for_another_humanoid_is_refused(tmp_path):
    swaying_clip().save(tmp_path / "sway.npz")
    with np.load(tmp_path / "sway.npz") as file:
        data = dict(file)
    np.savez(tmp_path / "other.npz", **{**data, "humanoid_id": np.array("another")})
    with pytest.raises(InputFileError, match="another"):
        load_clip(tmp_path / "other.npz")
