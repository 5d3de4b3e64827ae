"""Tests for the renderer: what is in the picture, where, and what is written."""

from __future__ import annotations

from io import StringIO

import imageio.v3 as imageio
import numpy as np
import pytest
from rich.console import Console

from tests.recording.bags import record_session
from tests.samples import standing, swaying, swaying_clip
from unicon.errors import InputFileError
from unicon.render import gl
from unicon.render.camera import CameraConfig, look_at
from unicon.render.gl import NoGLError, choose_gl
from unicon.render.scene import Picture
from unicon.render.show import RenderConfig, render, tile
from unicon.render.stage import Stage
from unicon.render.take import Take, load_take, take_from_clip
from unicon.state import stack

SMALL = Picture(160, 120)


def has_gl() -> bool:
    try:
        choose_gl()
        return True
    except NoGLError:
        return False


needs_gl = pytest.mark.skipif(not has_gl(), reason="no OpenGL on this machine can draw without a screen")


def yellow(picture: np.ndarray) -> np.ndarray:
    red, green, blue = (picture[..., k].astype(int) for k in range(3))
    return (red > blue + 60) & (green > blue + 30)


def two_takes() -> Take:
    avatars, targets = stack([standing(0.0), standing(0.0)]), stack([standing(0.0), standing(0.0)])
    return Take(np.array([0.0, 1 / 60]), avatars, targets, ("one", "two"))


@needs_gl
def test_the_avatar_is_yellow_and_in_the_middle():
    with Stage(take_from_clip(swaying_clip(3)), SMALL, CameraConfig(), "overlay") as stage:
        rows, columns = np.nonzero(yellow(stage.draw(0, with_caption=False)))
    assert len(rows) > 100
    assert abs(columns.mean() - 80) < 10


@needs_gl
def test_side_by_side_the_target_stands_beside_the_avatar():
    with Stage(two_takes(), SMALL, CameraConfig(), "side_by_side") as stage:
        _, columns = np.nonzero(yellow(stage.draw(0, with_caption=False)))
    assert abs(columns.mean() - 80) > 15


@needs_gl
def test_an_avatar_that_moves_moves_in_the_picture():
    take = Take(np.arange(2) / 60, stack([standing(0.0, 0.8), standing(0.0, -0.8)]), None, ("", ""))
    camera = CameraConfig(azimuth_deg=0.0, smoothing_s=10.0)
    with Stage(take, SMALL, camera, "overlay") as stage:
        centres = [np.nonzero(yellow(stage.draw(k, with_caption=False)))[1].mean() for k in range(2)]
    assert centres[1] > centres[0] + 20


@needs_gl
def test_a_video_and_a_contact_sheet_are_written_and_read_back(tmp_path):
    config = RenderConfig(
        video=tmp_path / "v.mp4", contact_sheet=tmp_path / "c.png", columns=3, rows=2, picture=SMALL
    )
    render(take_from_clip(swaying_clip(31)), config, Console(file=StringIO()))
    assert imageio.imread(tmp_path / "v.mp4").shape == (16, 120, 160, 3)
    assert imageio.imread(tmp_path / "c.png").shape == (2 * 126 + 6, 3 * 166 + 6, 3)


def test_the_camera_never_jerks_where_the_avatar_is_put_elsewhere():
    jump = stack([standing(0.0)] * 120 + [standing(3.0)] * 120)
    points = look_at(Take(np.arange(240) / 60, jump, None, ("",) * 240), CameraConfig())
    acceleration = np.diff(points, n=2, axis=0) * 60**2
    assert np.abs(acceleration).max() < 6.0
    assert np.allclose(points[-1, 0], 3.0, atol=0.05)


def test_an_avatar_left_lying_is_left_behind():
    avatar, target = swaying(100, speed=0.0), swaying(100, speed=6.0)
    points = look_at(Take(np.arange(100) / 60, avatar, target, ("",) * 100), CameraConfig())
    assert abs(points[-1, 0] - target.root_pos_w[-1, 0]) < 2.5


def test_pictures_are_tiled_with_a_border():
    sheet = tile([np.zeros((4, 6, 3), np.uint8)] * 3, columns=2)
    assert sheet.shape == (2 * 10 + 6, 2 * 12 + 6, 3)
    assert (sheet[6:10, 6:12] == 0).all()
    assert (sheet[16:20, 18:24] == 255).all()


def test_a_bag_and_a_clip_are_both_takes(tmp_path):
    record_session(tmp_path / "bag", ticks=30)
    swaying_clip(20).save(tmp_path / "sway.npz")
    bag, clip = load_take(tmp_path / "bag"), load_take(tmp_path / "sway.npz")
    assert len(bag.times_s) == 30
    assert bag.target is not None
    assert bag.captions[0] == "waiting"
    assert (len(clip.times_s), clip.target, clip.captions[0]) == (20, None, "sway")


def test_what_is_neither_is_named(tmp_path):
    with pytest.raises(InputFileError, match="notes.txt"):
        load_take(tmp_path / "notes.txt")


def test_a_part_that_is_not_there_is_refused():
    config = RenderConfig(start_s=5.0)
    with pytest.raises(InputFileError, match="nothing lies between"):
        render(take_from_clip(swaying_clip(10)), config, Console(file=StringIO()))


def test_without_any_opengl_it_says_what_to_install(monkeypatch):
    monkeypatch.setattr(gl, "works", lambda candidate: False)
    gl.choose_gl.cache_clear()
    try:
        with pytest.raises(NoGLError, match="sudo apt install libegl1"):
            gl.choose_gl()
    finally:
        gl.choose_gl.cache_clear()
