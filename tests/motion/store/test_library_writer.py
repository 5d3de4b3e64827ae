"""Tests for library_writer.py."""

from __future__ import annotations

import errno
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.motion.store.test_library import write_library
from tests.samples import swaying_clip
from unicon.errors import UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store import library_writer as module
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter, replace_infos


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_library_is_an_index_and_one_file_of_frames(tmp_path):
    folder = write_library(tmp_path / "library", {"walk": 90})
    frames, index = files(folder)
    assert frames.startswith("frames-") and index == "index.json"
    assert np.load(folder / frames).shape == (90, 83)


def test_a_new_library_replaces_the_old_one_and_its_frames(tmp_path):
    folder = write_library(tmp_path / "library", {"walk": 90})
    opened = ClipLibrary(folder)
    write_library(folder, {"run": 30})
    assert ClipLibrary(folder).names == ["run"]
    assert len(files(folder)) == 2
    assert len(opened.get("walk")) == 90, "what is open stays readable"


def test_the_same_clips_give_the_same_bytes(tmp_path):
    one = write_library(tmp_path / "one", {"walk": 90, "run": 30})
    two = write_library(tmp_path / "two", {"walk": 90, "run": 30})
    assert files(one) == files(two)
    assert all((one / name).read_bytes() == (two / name).read_bytes() for name in files(one))


def test_without_commit_the_old_library_stays(tmp_path):
    folder = write_library(tmp_path / "library", {"walk": 90})
    before = files(folder)
    with pytest.raises(RuntimeError), LibraryWriter(folder) as writer:
        writer.add_clip(swaying_clip(30, name="run"))
        raise RuntimeError
    assert files(folder) == before
    assert ClipLibrary(folder).names == ["walk"]


@pytest.mark.parametrize("step", ["write_index", "os.fsync"])
def test_a_crash_between_the_steps_of_a_commit_leaves_the_old_library(tmp_path, monkeypatch, step):
    folder = write_library(tmp_path / "library", {"walk": 90})

    def crash(*arguments: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(f"unicon.motion.store.library_writer.{step}", crash)
    with pytest.raises(UniconError, match="No space left on device"):
        write_library(folder, {"run": 30})
    monkeypatch.undo()
    assert ClipLibrary(folder).names == ["walk"]
    write_library(folder, {"run": 30})
    assert len(files(folder)) == 2, "what the crash left is gone"


def test_a_full_disk_is_said_in_one_sentence(tmp_path):
    with LibraryWriter(tmp_path / "library") as writer:
        with Path("/dev/full").open("wb", buffering=0) as full:
            writer._file, real = full, writer._file
            with pytest.raises(UniconError, match=r"library: the clip library cannot be written \(No space"):
                writer.add_clip(swaying_clip(30))
            writer._file = real


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(UniconError, match="choose another folder"):
        LibraryWriter(tmp_path / "file" / "library")


def test_a_name_is_taken_once_and_a_clip_has_two_frames(tmp_path):
    with LibraryWriter(tmp_path / "library") as writer:
        writer.add_clip(swaying_clip(30, name="walk"))
        with pytest.raises(ValueError, match="already a clip 'walk'"):
            writer.add_clip(swaying_clip(30, name="walk"))
        with pytest.raises(ValueError, match="at least 2 rows"):
            writer.add_rows(ClipInfo("short", 1), np.zeros((1, module.WIDTH)))


def test_what_is_said_of_clips_can_be_replaced_without_their_frames(tmp_path):
    folder = write_library(tmp_path / "library", {"walk": 90, "run": 30})
    library = ClipLibrary(folder)
    replace_infos(library, [replace(info, split="test") for info in library.infos])
    again = ClipLibrary(folder)
    assert [info.split for info in again.infos] == ["test", "test"]
    assert np.array_equal(again.array, library.array)
    with pytest.raises(ValueError, match="in its order"):
        replace_infos(library, library.infos[::-1])
