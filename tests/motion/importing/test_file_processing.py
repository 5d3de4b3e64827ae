"""Tests for importing.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.samples import swaying_clip
from unicon.errors import UniconError
from unicon.motion.cleaning import Order
from unicon.motion.formats.bvh_export import write_bvh
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.importing.file_processing import (
    OWN_FAMILY,
    ImportTask,
    fingerprint,
    hints_of,
    process,
    process_file,
)
from unicon.motion.importing.processed_file import ProcessedFile, load_processed
from unicon.motion.store.library import as_states


def task_of(path: Path, result: Path | None = None, **options: object) -> ImportTask:
    return ImportTask(MotionFile.from_path(path), result=result or path.parent / "result.npz", **options)


@pytest.fixture
def text(tmp_path) -> Path:
    path = tmp_path / "walk.bvh"
    path.write_text("one")
    return path


def test_a_fingerprint_changes_with_bytes_and_orders_and_with_nothing_else(text):
    first = fingerprint(task_of(text))
    assert first == fingerprint(task_of(text, result=Path("elsewhere"), size=7))
    ordered = fingerprint(task_of(text, order=Order(drop=True)))
    assert (ordered.content, ordered.key == first.key) == (first.content, False)
    text.write_text("two")
    changed = fingerprint(task_of(text))
    assert changed.content != first.content and changed.key != first.key


def test_the_same_bytes_under_another_name_have_another_key(text):
    other = text.with_name("run.bvh")
    other.write_text("one")
    one, two = fingerprint(task_of(text)), fingerprint(task_of(other))
    assert one.content == two.content and one.key != two.key


def test_the_skeleton_file_of_an_amc_counts_too(tmp_path):
    (tmp_path / "09.asf").write_text("skeleton")
    (tmp_path / "09_01.amc").write_text("motion")
    first = fingerprint(task_of(tmp_path / "09_01.amc"))
    (tmp_path / "09.asf").write_text("another")
    assert fingerprint(task_of(tmp_path / "09_01.amc")).key != first.key


def test_a_file_that_is_gone_has_an_error_for_a_fingerprint(tmp_path):
    mark = fingerprint(task_of(tmp_path / "none.bvh"))
    assert mark.key == "" and "none.bvh: cannot be read" in mark.error


def test_whatever_goes_wrong_becomes_the_reason_of_a_refusal(text):
    def refuse(task: ImportTask) -> ProcessedFile:
        raise UniconError("walk.bvh, line 1: is wrong")

    def starve(task: ImportTask) -> ProcessedFile:
        raise MemoryError

    assert process(task_of(text), refuse).refused == "walk.bvh, line 1: is wrong"
    hungry = process(task_of(text, result=text.with_name("other.npz")), starve)
    assert "memory" in hungry.refused and hungry.retry


def test_a_result_is_left_on_disk_and_taken_from_there(text):
    first = process(task_of(text), lambda task: ProcessedFile(family="made_up"))
    assert load_processed(text.with_name("result.npz")) == first
    assert process(task_of(text), lambda task: ProcessedFile(family="other")).family == "made_up"


def test_what_failed_for_want_of_memory_is_not_taken_from_disk(text):
    process(task_of(text), lambda task: ProcessedFile(refused="no memory", retry=True))
    assert process(task_of(text), lambda task: ProcessedFile(family="made_up")).family == "made_up"


def test_a_damaged_result_is_made_again(text):
    text.with_name("result.npz").write_bytes(b"PK\x03\x04 cut off")
    assert process(task_of(text), lambda task: ProcessedFile(family="made_up")).family == "made_up"


def test_a_clip_in_a_file_of_its_own_is_taken_as_it_is(tmp_path):
    clip = swaying_clip(60)
    clip.save(tmp_path / "sway.npz")
    result = process_file(task_of(tmp_path / "sway.npz"))
    (stored,) = result.clips
    assert (result.family, stored.info.name, stored.info.label) == (OWN_FAMILY, "sway", "test")
    assert np.allclose(as_states(stored.rows).joint_pos, clip.frames.joint_pos, atol=1e-6)


def test_a_clip_for_another_humanoid_is_refused_by_its_own_name(tmp_path):
    swaying_clip(60).save(tmp_path / "sway.npz")
    with np.load(tmp_path / "sway.npz") as file:
        data = dict(file)
    np.savez(tmp_path / "sway.npz", **{**data, "humanoid_id": np.array("another")})
    with pytest.raises(UniconError, match=r"sway.npz: was made for humanoid another"):
        process_file(task_of(tmp_path / "sway.npz"))


def test_a_file_goes_through_the_whole_chain(tmp_path):
    sway = swaying_clip(180)
    write_bvh(sway.frames, tmp_path / "sway.bvh")
    result = process_file(task_of(tmp_path / "sway.bvh"))
    (clip,) = result.clips
    assert result.family and clip.info.name == "sway"
    assert abs(clip.info.frames - 180) <= 1
    assert clip.info.quality["mean_error_mm"] < 40.0
    elbow = as_states(clip.rows).joint_pos[:, -1]
    assert np.isfinite(elbow).all()


def test_an_order_to_drop_a_file_is_its_reason(tmp_path):
    write_bvh(swaying_clip(180).frames, tmp_path / "sway.bvh")
    with pytest.raises(UniconError, match=r"sway.bvh: drop .* Not wanted"):
        process_file(task_of(tmp_path / "sway.bvh", order=Order(reason="not wanted", drop=True)))


def test_names_and_the_index_of_cmu_give_hints():
    hints = hints_of("cmu.zip/60_01.bvh")
    assert hints.file == "cmu.zip/60_01.bvh"
    assert "salsa" in hints.description.lower() + hints.context.lower()
    assert hints.capture_hz == 60.0
    assert hints_of("mine/walk.bvh").capture_hz is None
