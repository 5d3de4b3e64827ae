"""Tests for library_stats.py."""

from __future__ import annotations

import json
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

from tests.samples import swaying_clip
from unicon.errors import UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing.import_report import FileRecord, ImportReport, ImportRun, write_report
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_stats import library_stats, show_stats
from unicon.motion.store.library_writer import LibraryWriter
from unicon.state import CharacterState


@pytest.fixture
def library(tmp_path):
    with LibraryWriter(tmp_path / "library") as writer:
        sway = swaying_clip(100).frames
        sunk = CharacterState(**{**vars(sway), "root_pos_w": sway.root_pos_w - np.array([0.0, 0.0, 0.05])})
        good = {"mean_error_mm": 10.0, "skate_mm_per_frame": 1.0, "contact_share": 1.0}
        poor = {"mean_error_mm": 40.0, "skate_mm_per_frame": 3.0, "contact_share": 0.5}
        writer.add(ClipInfo("walk", 100, "walking/forward", quality=good), sway)
        writer.add(ClipInfo("sunk", 100, "other", quality=poor), sunk)
        writer.commit()
    return ClipLibrary(tmp_path / "library")


def test_figures_are_means_over_the_frames_they_are_about(library):
    stats = library_stats(library)
    assert (stats.clips, stats.frames, stats.other_percent) == (2, 200, 50.0)
    assert stats.mean_error_mm == pytest.approx(25.0)
    assert stats.skate_mm_per_frame == pytest.approx((100 * 1.0 + 50 * 3.0) / 150)


def test_penetration_is_measured_on_the_frames(library):
    assert library_stats(library).penetration_p99_mm == pytest.approx(50.0, abs=1.0)


def test_times_come_from_the_report_of_the_import(library):
    assert library_stats(library).to_dict()["import_seconds"] is None
    report = ImportReport((FileRecord("a", "c", "k", frames=200, seconds=0.1),), (ImportRun(3.0, 2, 1, 0),))
    write_report(library.folder, report, library.infos)
    stats = library_stats(library)
    assert (stats.import_seconds, stats.frames_per_second_per_core) == (3.0, pytest.approx(2000.0))


def test_figures_and_sub_datasets_are_written_and_shown(library, tmp_path):
    console = Console(file=StringIO(), width=120)
    show_stats(library, tmp_path / "out" / "motions.json", console)
    content = json.loads((tmp_path / "out" / "motions.json").read_text())
    assert {
        "clips",
        "frames",
        "import_seconds",
        "frames_per_second_per_core",
        "mean_error_mm",
        "penetration_p99_mm",
        "skate_mm_per_frame",
        "other_percent",
        "subsets",
    } <= set(content)
    assert next(row for row in content["subsets"] if row["name"] == "Walk")["motions"] == 1
    assert "not measured" in console.file.getvalue() and "RunJumpWalk" in console.file.getvalue()


def test_a_file_that_cannot_be_written_is_named(library):
    with pytest.raises(UniconError, match="/proc/motions.json: cannot be written"):
        show_stats(library, library.folder.__class__("/proc/motions.json"), Console(file=StringIO()))
