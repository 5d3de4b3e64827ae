"""Tests for library_choice.py and the library that is shipped."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from tests.samples import swaying_clip
from unicon.motion.catalogue import provenance_of
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_choice import SHIPPED, open_library
from unicon.motion.store.library_writer import LibraryWriter

WANTED = {"stand", "idle_shift", "walk", "turn_left", "turn_right", "jog", "run", "jump", "wave", "punch"}
WANTED |= {"kick", "dance", "get_up"}


def make_library(folder: Path) -> Path:
    with LibraryWriter(folder) as writer:
        writer.add_clip(swaying_clip(60))
        writer.commit()
    return folder


def test_what_is_named_comes_first_then_the_variable_then_the_shipped_one(tmp_path, monkeypatch):
    monkeypatch.delenv("UNICON_LIBRARY", raising=False)
    named, chosen = make_library(tmp_path / "named"), make_library(tmp_path / "chosen")
    assert open_library(None, Console()).folder == SHIPPED
    monkeypatch.setenv("UNICON_LIBRARY", str(chosen))
    assert open_library(None, Console()).folder == chosen
    assert open_library(named, Console()).folder == named


def test_the_shipped_clips_are_small_free_and_on_the_floor():
    library = ClipLibrary(SHIPPED)
    assert set(library.names) >= WANTED
    assert sum(path.stat().st_size for path in SHIPPED.iterdir()) < 2_000_000
    notices = (SHIPPED / "LICENCES.txt").read_text()
    for info in library.infos:
        assert 2.0 <= info.seconds <= 10.0
        assert provenance_of(info.origin).shippable
        assert info.licence and info.source
        assert info.quality["penetration_p99_mm"] < 20
        assert info.quality["mean_error_mm"] < 40
    assert "mocap.cs.cmu.edu" in notices


@pytest.mark.parametrize("name", ["walk", "walk_slow", "turn_left", "turn_right", "run"])
def test_shipped_gaits_are_as_fast_at_their_ends_as_in_the_middle(name):
    frames = ClipLibrary(SHIPPED).get(name).frames
    speed = np.linalg.norm(frames.root_lin_vel_w[:, :2], axis=-1)
    middle = speed[30:-30]
    assert 0.95 * middle.min() < min(speed[0], speed[-1])
