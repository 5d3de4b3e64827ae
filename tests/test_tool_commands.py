"""Tests for tool_commands.py: each command as a person calls it."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from tests.motion.fetching.test_download import site  # noqa: F401 - a fixture
from tests.recording.bags import record_session
from tests.samples import swaying_clip
from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.store.library_writer import LibraryWriter
from unicon.recording.bag_reading import read_recording
from unicon.tool_commands import FetchCmu, MotionsExport, MotionsInspect


@pytest.fixture
def console() -> Console:
    return Console(file=StringIO(), width=200)


@pytest.fixture
def library(tmp_path) -> Path:
    with LibraryWriter(tmp_path / "library") as writer:
        writer.add_clip(swaying_clip(60, name="bow"))
        writer.commit()
    return writer.folder


@pytest.fixture(scope="module")
def bag(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("bags") / "session"
    record_session(folder, ticks=60)
    return folder


def root_path_m(path: Path) -> np.ndarray:
    return 0.01 * read_bvh(MotionFile.from_path(path)).root_pos


def test_a_clip_of_a_library_is_exported(library, tmp_path, console):
    out = tmp_path / "bow.bvh"
    assert MotionsExport("bow", out=out, library=library).run(console) == 0
    assert np.allclose(root_path_m(out), swaying_clip(60).frames.root_pos_w, atol=1e-6)
    assert str(out) in console.file.getvalue()


def test_a_clip_of_its_own_is_exported_into_the_present_folder(tmp_path, console, monkeypatch):
    monkeypatch.chdir(tmp_path)
    swaying_clip(60).save(tmp_path / "sway.npz")
    MotionsExport("sway.npz").run(console)
    assert len(root_path_m(tmp_path / "sway.bvh")) == 60


@pytest.mark.parametrize("target", [False, True])
def test_of_a_recording_the_avatar_or_its_target_is_exported(bag, tmp_path, console, target):
    out = tmp_path / "session.bvh"
    MotionsExport(str(bag), out=out, target=target).run(console)
    states = read_recording(bag, ("state",)).states
    expected = np.array([(s.target if target else s.actual).root_pos_w for s in states])
    assert np.allclose(root_path_m(out), expected, atol=1e-5)


def test_only_a_recording_has_a_target(library, console):
    with pytest.raises(UniconError, match="only those have a target"):
        MotionsExport("bow", library=library, target=True).run(console)


def test_an_unknown_clip_is_answered_with_the_nearest(library, console):
    for command in (MotionsExport("bou", library=library), MotionsInspect("bou", library=library)):
        with pytest.raises(UnknownNameError, match="the nearest are bow"):
            command.run(console)
    with pytest.raises(InputFileError, match=r"none\.npz"):
        MotionsInspect("none.npz").run(console)


def test_a_clip_is_inspected(library, tmp_path, console):
    plots = tmp_path / "bow.png"
    assert MotionsInspect("bow", library=library, plots=plots).run(console) == 0
    assert plots.read_bytes().startswith(b"\x89PNG")
    assert "penetration_p99_mm" in console.file.getvalue()


def test_subjects_are_fetched_and_what_is_next_is_said(site, tmp_path, console):  # noqa: F811
    site.files = {"/copy/subjects/45/45.asf": b"skeleton"}
    assert FetchCmu((45,), tmp_path / "cmu", f"{site.url}/copy/").run(console) == 0
    said = console.file.getvalue()
    assert "1 files fetched, 0 were there" in said
    assert "does not have 1 takes that its index names: 45_01.amc" in said
    assert f"unicon motions import {tmp_path / 'cmu'}" in said
