"""Tests for evaluation.py and evaluation_clips.py: sources, processes, and the figures of classes."""

from __future__ import annotations

import zipfile

import numpy as np
import pytest
from rich.console import Console

from tests.samples import swaying_clip
from tests.train.clip_samples import small_library
from tests.train.policy_samples import make_policy
from unicon.errors import UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.policy import ReferenceServo
from unicon.train.scoring.evaluation import Evaluation, evaluate, summarise
from unicon.train.scoring.evaluation_clips import from_clips, from_library, from_path
from unicon.train.scoring.evaluation_runs import KinematicPolicy, run_clips
from unicon.train.scoring.tracking_metrics import ClipScores


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return small_library(tmp_path_factory.mktemp("clips") / "library")


def names(source) -> list[str]:
    return sorted(info.name for info in source.infos)


def make_scores(**changes) -> ClipScores:
    values = {name: 0.0 for name in ClipScores._fields} | {
        "ticks": 10,
        "scored_ticks": 10,
        "first_broken": "",
    }
    return ClipScores(**{**values, **changes})


def test_a_library_gives_the_clips_of_a_side_and_a_sub_dataset_without_marks(library):
    assert names(from_library(library)) == ["lean", "march", "stroll", "sway"]
    assert names(from_library(library, split="test")) == ["march", "sway"]
    assert names(from_library(library, "Walk", "train")) == ["stroll"]


def test_a_folder_and_an_archive_of_clips_are_read_as_an_import_reads_them(tmp_path, library):
    folder = tmp_path / "motions"
    folder.mkdir()
    for name in ("one", "two"):
        swaying_clip(40, name=name).save(folder / f"{name}.npz")
    (folder / "broken.npz").write_bytes(b"nothing")
    console = Console(record=True, width=200)
    source = from_path(folder, 1, console)
    assert names(source) == ["one", "two"]
    assert "broken.npz" in console.export_text()
    with zipfile.ZipFile(tmp_path / "motions.zip", "w") as archive:
        archive.write(folder / "one.npz", "inner/one.npz")
    (packed,) = from_path(tmp_path / "motions.zip", 1, console).load()
    assert np.allclose(packed.frames.joint_pos, swaying_clip(40).frames.joint_pos, atol=1e-6)


def test_clips_of_the_same_name_get_numbers(tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        swaying_clip(40, name="walk").save(tmp_path / folder / "walk.npz")
    swaying_clip(41, 0.3, name="walk").save(tmp_path / "a" / "again.npz")
    assert names(from_path(tmp_path, 1, Console(quiet=True))) == ["walk", "walk#2", "walk#3"]


def test_a_folder_without_motions_is_refused(tmp_path):
    with pytest.raises(UniconError, match="no motion that can be used"):
        from_path(tmp_path, 1, Console(quiet=True))


def test_a_library_and_the_same_clips_in_memory_give_the_same_answer(library):
    source = from_library(library)
    here = evaluate(ReferenceServo(), source, jobs=1)
    there = evaluate(ReferenceServo(), from_clips(source.load()), jobs=1)
    assert here.scores == there.scores


def test_the_answer_is_the_same_whatever_the_number_of_processes(library):
    source = from_library(library)
    policy = make_policy(action="torque-servo", scale=0.1)
    done = []
    alone = evaluate(policy, source, jobs=1, on_done=done.append)
    assert sum(done) == 4
    assert repr(evaluate(policy, source, jobs=2).scores) == repr(alone.scores)
    one_by_one = [run_clips(policy, [clip])[0].score() for clip in source.load()]
    assert repr(tuple(one_by_one)) == repr(alone.scores)


def test_the_target_itself_survives_everywhere(library):
    whole, *classes = summarise(evaluate(KinematicPolicy(), from_library(library), jobs=1))
    assert [group.path for group in classes] == ["standing", "walking", "walking/fast", "walking/slow"]
    assert (whole.clips, whole.ticks) == (4, 59 + 44 + 89 + 39)
    for group in (whole, *classes):
        figures = group.figures
        assert (figures["survival"], figures["success"], figures["success_s3"]) == (1.0, 1.0, 1.0)
        assert figures["global_mm"] < 1e-6


def test_shares_are_means_over_clips_and_errors_over_frames():
    infos = (ClipInfo("a", 11, "x"), ClipInfo("b", 31, "x"), ClipInfo("c", 11, "y"))
    scores = (
        make_scores(success=1.0, survival=1.0, global_mm=10.0, chatter=0.2),
        make_scores(ticks=30, scored_ticks=30, survival=0.5, global_mm=50.0, chatter=float("nan")),
        make_scores(scored_ticks=0, global_mm=float("nan"), chatter=float("nan")),
    )
    whole, x, y = summarise(Evaluation("p", "clips", infos, scores))
    assert whole.figures["survival"] == pytest.approx(0.5)
    assert x.figures["success"] == pytest.approx(0.5)
    assert x.figures["global_mm"] == whole.figures["global_mm"] == pytest.approx((10 * 10 + 30 * 50) / 40)
    assert x.figures["chatter"] == pytest.approx(0.2)
    assert np.isnan(y.figures["global_mm"])
