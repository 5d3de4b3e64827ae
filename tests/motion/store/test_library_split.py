"""Tests for library_split.py."""

from __future__ import annotations

import pytest

from tests.motion.store.test_library import write_library
from unicon.motion.catalogue.split import SplitSettings
from unicon.motion.catalogue.split_file import read_split
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_split import divide, settings_of, split_table


@pytest.fixture
def folder(tmp_path):
    return write_library(tmp_path / "library", {f"walk_{k}": 30 for k in range(10)})


def test_a_split_is_written_into_the_index_and_a_file(folder):
    infos = divide(ClipLibrary(folder), SplitSettings(test_share=0.3))
    again = ClipLibrary(folder)
    assert list(again.infos) == infos
    assert sum(info.split == "test" for info in infos) == 3
    assert read_split(folder / "split.yaml").sides == {info.name: info.split for info in infos}
    assert settings_of(folder) == SplitSettings(test_share=0.3)


def test_a_split_changed_by_hand_is_taken_as_it_is(folder, tmp_path):
    divide(ClipLibrary(folder), SplitSettings(), file=tmp_path / "mine.yaml")
    text = (tmp_path / "mine.yaml").read_text().replace(": train", ": test")
    (tmp_path / "mine.yaml").write_text(text)
    infos = divide(ClipLibrary(folder), SplitSettings(), use=tmp_path / "mine.yaml")
    assert {info.split for info in infos} == {"test"}
    assert {info.split for info in ClipLibrary(folder).infos} == {"test"}


def test_a_library_that_was_never_divided_has_the_usual_settings(tmp_path):
    assert settings_of(tmp_path) == SplitSettings()


def test_the_shares_of_both_sides_are_shown(folder):
    infos = divide(ClipLibrary(folder), SplitSettings())
    cells = [list(column.cells) for column in split_table(infos).columns]
    assert cells[0] == ["train", "test"]
    assert cells[3] == ["80.0 %", "20.0 %"]
