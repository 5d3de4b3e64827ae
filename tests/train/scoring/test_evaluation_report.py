"""Tests for evaluation_report.py: tables, JSON, CSV and the picture."""

from __future__ import annotations

import csv
import json

import pytest
from PIL import Image
from rich.console import Console

from tests.train.clip_samples import small_library
from unicon.errors import UniconError
from unicon.policy import ReferenceServo
from unicon.train.scoring.evaluation import evaluate
from unicon.train.scoring.evaluation_clips import from_library
from unicon.train.scoring.evaluation_report import as_json, draw, tables, write_csv, write_json
from unicon.train.scoring.evaluation_runs import KinematicPolicy


@pytest.fixture(scope="module")
def evaluation(tmp_path_factory):
    library = small_library(tmp_path_factory.mktemp("report") / "library")
    return evaluate(ReferenceServo(), from_library(library), jobs=1)


def test_the_tables_have_a_row_a_class(evaluation):
    console = Console(record=True, width=200)
    for table in tables(evaluation):
        assert table.row_count == 5
        console.print(table)
    text = console.export_text()
    assert "standing" in text and "fast" in text and "joint velocity" in text
    assert "reference_servo: All of library, split all" in text


def test_the_json_has_everything_and_is_the_same_every_time(evaluation, tmp_path):
    write_json(tmp_path / "new" / "scores.json", as_json(evaluation))
    values = json.loads((tmp_path / "new" / "scores.json").read_text())
    assert values["all"]["clips"] == 4
    assert values["frames_file"].startswith("frames-")
    assert values["classes"]["walking"]["clips"] == 2
    assert {run["clip"] for run in values["runs"]} == {"stroll", "march", "sway", "lean"}
    assert values == json.loads(json.dumps(as_json(evaluation)))


def test_what_was_not_measured_is_null(tmp_path):
    library = small_library(tmp_path / "library")
    values = as_json(evaluate(KinematicPolicy(), from_library(library), jobs=1))
    assert values["all"]["skate_mm_per_frame"] is None
    assert "NaN" not in json.dumps(values)


def test_the_csv_has_rows_for_all_classes_and_clips(evaluation, tmp_path):
    write_csv(tmp_path / "scores.csv", evaluation)
    with (tmp_path / "scores.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["kind"] for row in rows] == ["all"] + ["class"] * 4 + ["clip"] * 4
    assert float(rows[0]["survival"]) == as_json(evaluation)["all"]["survival"]


def test_the_picture_is_a_picture(evaluation, tmp_path):
    draw(evaluation, tmp_path / "plots" / "scores.png")
    with Image.open(tmp_path / "plots" / "scores.png") as picture:
        assert min(picture.size) > 400


def test_a_file_that_cannot_be_written_is_named(evaluation, tmp_path):
    (tmp_path / "file").write_text("")
    for write in (
        lambda path: write_json(path, {}),
        lambda path: write_csv(path, evaluation),
        lambda path: draw(evaluation, path.with_suffix(".png")),
    ):
        with pytest.raises(UniconError, match="file"):
            write(tmp_path / "file" / "scores.json")
    with pytest.raises(UniconError, match=r"scores\.png"):
        draw(evaluation, tmp_path / "scores.tables")
