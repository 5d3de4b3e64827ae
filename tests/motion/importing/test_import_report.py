"""Tests for import_report.py."""

from __future__ import annotations

import json

import pytest

from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing.import_report import (
    FileRecord,
    ImportReport,
    ImportRun,
    join_quality,
    read_report,
    to_markdown,
    write_report,
)

REPORT = ImportReport(
    files=(
        FileRecord(
            "a.zip/walk.bvh",
            "c1",
            "k1",
            "daz",
            ("walk",),
            ("cut frames 0-3 (idle_end): x.",),
            frames=60,
            seconds=0.5,
        ),
        FileRecord(
            "a.zip/run.bvh",
            "c2",
            "k2",
            "daz",
            ("run",),
            ("cut frame 9 (idle_end): y.",),
            frames=30,
            seconds=0.25,
        ),
        FileRecord("b.bvh", "c3", "k3", refused="b.bvh: is no motion", seconds=9.0),
        FileRecord("copy.bvh", "c1", "k4", duplicate_of="a.zip/walk.bvh"),
    ),
    runs=(ImportRun(1.5, 2, 3, 0), ImportRun(0.5, 2, 1, 3)),
)
INFOS = [
    ClipInfo("walk", 60, "walking/forward", quality={"mean_error_mm": 10.0, "worst_error_mm": 50.0}),
    ClipInfo(
        "run", 30, "running", quality={"mean_error_mm": 40.0, "worst_error_mm": 20.0, "x": float("nan")}
    ),
]


def test_a_report_comes_back_as_it_was(tmp_path):
    write_report(tmp_path, REPORT, INFOS)
    assert read_report(tmp_path) == REPORT


@pytest.mark.parametrize("text", ["", "{}", '{"version": 99}', '{"version": 1, "files": [{}], "runs": []}'])
def test_a_report_that_cannot_be_used_is_an_empty_one(tmp_path, text):
    (tmp_path / "import_report.json").write_text(text)
    assert read_report(tmp_path) == ImportReport()
    assert read_report(tmp_path / "none") == ImportReport()


def test_speed_counts_only_files_that_became_clips():
    assert REPORT.frames_per_second_per_core == pytest.approx(90 / 0.75)
    assert REPORT.seconds == 2.0


def test_figures_are_means_over_frames_and_the_largest_of_worst():
    joined = join_quality(INFOS)
    assert joined == {"mean_error_mm": pytest.approx((60 * 10 + 30 * 40) / 90), "worst_error_mm": 50.0}


def test_people_read_totals_quality_reasons_and_decisions():
    text = to_markdown(REPORT, INFOS)
    assert "2 clips with 90 frames" in text
    assert "| daz | 2 | 1 | 20.00 | 50.00 |" in text
    assert "| walking | 1 | 1 | 10.00 | 50.00 |" in text
    assert "- b.bvh: is no motion" in text
    assert "- copy.bvh: holds the same as a.zip/walk.bvh" in text
    assert "- 2 x cut for idle_end" in text
    assert "- a.zip/run.bvh: cut frame 9 (idle_end): y." in text


def test_a_report_on_nothing_says_so(tmp_path):
    text = to_markdown(ImportReport(), [])
    assert text.count("None.") == 2
    write_report(tmp_path, ImportReport(), [])
    assert json.loads((tmp_path / "import_report.json").read_text())["files"] == []
