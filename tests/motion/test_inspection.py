"""Tests for inspection.py."""

from __future__ import annotations

from io import StringIO

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from tests.samples import swaying, swaying_clip
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip import clip_from_poses
from unicon.motion.clip_index import ClipInfo
from unicon.motion.inspection import inspect, plot, show

ELBOW = HUMANOID.joint_names.index("left_elbow")


def shown(inspection) -> str:
    console = Console(file=StringIO(), width=120)
    show(inspection, console)
    return console.file.getvalue()


def bent_clip():
    """Nine of twelve frames with an elbow at its limit."""
    poses = swaying(12)
    joint_pos = np.array(poses.joint_pos)
    joint_pos[3:, ELBOW] = HUMANOID.joint_lower[ELBOW]
    return clip_from_poses("bent", poses.root_pos_w, poses.root_quat_w, joint_pos)


def test_a_clip_of_a_library_is_shown_with_its_row():
    clip = swaying_clip(90)
    quality = {"mean_error_mm": 12.345, "skate_mm_per_frame": float("nan")}
    info = ClipInfo(
        "sway", 90, "idle/sway", "take", "a [studio]", "CC0", "a.zip/b.bvh", "test", ("prop",), quality
    )
    text = shown(inspect(clip, info))
    for word in (
        "1.48 s, 90 frames",
        "idle/sway",
        "prop",
        "a [studio]",
        "CC0",
        "a.zip/b.bvh",
        "test",
        "12.35",
    ):
        assert word in text
    assert "skate_mm_per_frame" in text
    assert "not measured" in text


def test_a_clip_by_itself_is_measured_as_far_as_that_can_be():
    inspection = inspect(swaying_clip(90))
    assert inspection.quality["penetration_p99_mm"] < 1.0
    assert np.isnan(inspection.quality["mean_error_mm"])
    assert inspection.contact.shape == (90, 2)
    assert inspection.contact.all()


def test_hinges_at_their_limits_are_named_with_their_share_of_the_frames():
    inspection = inspect(bent_clip())
    assert inspection.at_limit[:, ELBOW].sum() == 9
    assert "left_elbow at its limit" in shown(inspection)
    assert "75.0 % of the frames" in shown(inspection)


@pytest.mark.parametrize("make", [lambda: swaying_clip(2), bent_clip, lambda: swaying_clip(900, speed=2.0)])
def test_the_plots_are_one_picture_whatever_the_length(tmp_path, make):
    path = tmp_path / "plots" / "clip.png"
    plot(inspect(make()), path)
    with Image.open(path) as picture:
        assert picture.size == (1400, 1100)
        assert len(set(picture.convert("L").resize((140, 110)).tobytes())) > 20


def test_plots_that_cannot_be_written_are_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UniconError, match="the plots cannot be written"):
        plot(inspect(swaying_clip(10)), tmp_path / "file" / "clip.png")
