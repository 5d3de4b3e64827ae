"""Tests for motion_commands.py and library_choice.py: each command as a person types it."""

from __future__ import annotations

import json

import pytest

from tests.motion.store.test_library import write_library
from tests.samples import swaying_clip
from unicon import cli
from unicon.motion.formats.bvh_export import write_bvh
from unicon.motion.store.library import ClipLibrary


@pytest.fixture
def unicon(monkeypatch, capsys):
    """Run a command; return its exit status and what it says."""

    def run(*words: object) -> tuple[int, str]:
        monkeypatch.setattr("sys.argv", ["unicon", *map(str, words)])
        monkeypatch.setenv("COLUMNS", "200")
        status = cli.main()
        captured = capsys.readouterr()
        return status, captured.out + captured.err

    return run


@pytest.fixture
def folder(tmp_path):
    return write_library(tmp_path / "library", {"walk": 90, "run": 30})


def test_motions_are_imported_and_then_listed_and_counted(unicon, tmp_path):
    write_bvh(swaying_clip(120).frames, tmp_path / "walk.bvh")
    out = tmp_path / "library"
    status, said = unicon("motions", "import", tmp_path / "walk.bvh", "--out", out, "--jobs", 1)
    assert status == 0 and "1 clip," in said
    assert ClipLibrary(out).names == ["walk"]
    assert "nothing new" in unicon("motions", "import", tmp_path / "walk.bvh", "--out", out)[1]
    assert "walk" in unicon("motions", "list", out)[1]
    assert "walking" in unicon("motions", "tree", out)[1]
    unicon("motions", "stats", out, "--json", tmp_path / "motions.json")
    assert json.loads((tmp_path / "motions.json").read_text())["clips"] == 1
    status, said = unicon("motions", "split", out)
    assert status == 0 and "test" in said


def test_a_list_is_cut_down_by_name_and_class(unicon, folder):
    said = unicon("motions", "list", folder, "--name", "WAL")[1]
    assert "walk" in said and "run" not in said
    assert "run" in unicon("motions", "list", folder, "--label", "test")[1]
    status, said = unicon("motions", "list", folder, "--label", "tes")
    assert status == 2 and "no clip fits" in said


def test_the_library_is_that_of_the_environment_where_none_is_named(unicon, folder, monkeypatch):
    monkeypatch.setenv("UNICON_LIBRARY", str(folder))
    assert "run" in unicon("motions", "list")[1]
    monkeypatch.setenv("UNICON_LIBRARY", str(folder / "none"))
    status, said = unicon("motions", "stats")
    assert status == 2 and "there is no such clip library" in said


def test_mistakes_are_answered_in_one_sentence(unicon, tmp_path):
    status, said = unicon("motions", "import", "--out", tmp_path / "library")
    assert status == 2 and said.strip().startswith("unicon: there is nothing to import")
    status, said = unicon("motions", "import", tmp_path / "none", "--out", tmp_path / "library")
    assert status == 2 and "does not exist" in said
    assert len(said.strip().splitlines()) == 1
