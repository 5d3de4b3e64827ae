"""Tests for motion_file.py, on folders and archives made here."""

from __future__ import annotations

import json
import os
import pickle
import zipfile

import pytest

from unicon.errors import InputFileError
from unicon.motion.formats.motion_file import MOTION_SUFFIXES, MotionFile, find_motion_files, is_deepmimic
from unicon.motion.formats.readers import MOTION_READERS

FRAMES = json.dumps({"Loop": "wrap", "Frames": [[0.0] * 44] * 300}).encode()
FILES = {
    "LICENCES.txt": b"Free for all {uses}",
    "README.md": b"# Motions",
    "walk.bvh": b"HIERARCHY walk",
    "walk_gait.txt": b"0.1 0.2\n0.3 0.4\n",
    "settings.json": b'{"fps": 30}',
    "run.txt": b"\xef\xbb\xbf \n" + FRAMES,
    "jump.JSON": FRAMES,
    "09/09_06.amc": b":DEGREES",
    "09/09.asf": b":version 1.10",
    "poses/hop.npz": b"PK",
    "poses/.hop.npz": b"hidden",
    "__MACOSX/._walk.bvh": b"hidden",
}
MOTIONS = ["09/09_06.amc", "jump.JSON", "poses/hop.npz", "run.txt", "walk.bvh"]


def make_folder(folder):
    for name, content in FILES.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return folder


def make_archive(path, files=FILES, packing=zipfile.ZIP_LZMA):
    with zipfile.ZipFile(path, "w", packing) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def test_all_kinds_that_are_looked_for_have_a_reader():
    assert set(MOTION_SUFFIXES) == set(MOTION_READERS)


def test_a_folder_gives_its_motions_and_nothing_else(tmp_path):
    found = find_motion_files([make_folder(tmp_path)])
    assert sorted(file.origin for file in found) == sorted(str(tmp_path / name) for name in MOTIONS)
    assert {file.name: file.suffix for file in found}["jump"] == ".json"
    assert all(file.read() == FILES[os.path.relpath(file.origin, tmp_path)] for file in found)


@pytest.mark.parametrize("packing", [zipfile.ZIP_LZMA, zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED])
def test_an_archive_gives_the_same_motions_as_the_folder(tmp_path, packing):
    found = find_motion_files([make_archive(tmp_path / "all.zip", packing=packing)])
    assert [file.origin for file in found] == [f"all.zip/{name}" for name in MOTIONS]
    assert [file.name for file in found] == ["09_06", "jump", "hop", "run", "walk"]
    assert all(file.read() == FILES[file.member] for file in found)


def test_archives_in_folders_are_looked_into(tmp_path):
    (tmp_path / "deep").mkdir()
    make_archive(tmp_path / "deep" / "a.zip", {"take.bvh": b"1"})
    assert [file.origin for file in find_motion_files([tmp_path])] == ["a.zip/take.bvh"]


def test_nothing_is_found_twice(tmp_path):
    make_folder(tmp_path)
    found = find_motion_files([tmp_path, tmp_path / "walk.bvh", tmp_path / "poses"])
    assert len(found) == len(MOTIONS)


def test_a_file_named_by_itself_counts_whatever_it_holds(tmp_path):
    path = make_folder(tmp_path) / "LICENCES.txt"
    assert [file.origin for file in find_motion_files([path])] == [str(path)]


def test_a_file_goes_to_another_process_and_is_read_there(tmp_path):
    (file,) = find_motion_files([make_archive(tmp_path / "a.zip", {"take.bvh": b"1"})])
    file.read()
    assert pickle.loads(pickle.dumps(file)).read() == b"1"


def test_an_archive_that_was_replaced_is_read_anew(tmp_path):
    (file,) = find_motion_files([make_archive(tmp_path / "a.zip", {"take.bvh": b"old"})])
    assert file.read() == b"old"
    make_archive(tmp_path / "a.zip", {"take.bvh": b"newer"})
    assert file.read() == b"newer"


@pytest.mark.parametrize("packed", [False, True])
def test_a_sibling_is_in_the_same_folder(tmp_path, packed):
    path = make_archive(tmp_path / "a.zip") if packed else make_folder(tmp_path)
    take = next(file for file in find_motion_files([path]) if file.suffix == ".amc")
    skeleton = take.sibling("*.asf")
    assert skeleton is not None
    assert skeleton.read() == FILES["09/09.asf"]
    assert skeleton.suffix == ".asf"
    assert skeleton.origin.endswith("09/09.asf")
    assert take.sibling("*.fbx") is None


@pytest.mark.parametrize(
    ("others", "fits"),
    [
        (["any.ASF"], "any.ASF"),
        (["1.asf", "13.asf", "131.asf"], "13.asf"),
        (["14.asf", "15.asf"], None),
    ],
)
def test_of_several_siblings_the_one_named_alike_is_taken(tmp_path, others, fits):
    for name in ("13_05.amc", *others):
        (tmp_path / name).write_bytes(b"")
    sibling = MotionFile.from_path(tmp_path / "13_05.amc").sibling("*.asf")
    assert (sibling and sibling.path.name) == fits


def test_a_path_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputFileError, match=r"nowhere: does not exist"):
        find_motion_files([tmp_path / "nowhere"])


def test_a_file_of_an_unknown_kind_lists_the_known_ones(tmp_path):
    (tmp_path / "take.fbx").write_bytes(b"")
    with pytest.raises(
        InputFileError, match=r"take.fbx: there is no reader for '.fbx' files, only for .amc, .bvh"
    ):
        find_motion_files([tmp_path / "take.fbx"])


def test_a_damaged_archive_among_others_stops_nothing_and_says_so_when_read(tmp_path):
    (tmp_path / "broken.zip").write_bytes(b"PK no archive")
    (tmp_path / "walk.bvh").write_bytes(b"1")
    found = find_motion_files([tmp_path])
    assert [file.suffix for file in found] == [".zip", ".bvh"]


def test_a_damaged_member_is_named(tmp_path):
    path = make_archive(tmp_path / "a.zip", {"take.bvh": b"12345678" * 40}, zipfile.ZIP_STORED)
    path.write_bytes(path.read_bytes().replace(b"1234567812", b"1234567821", 1))
    (file,) = find_motion_files([path])
    with pytest.raises(InputFileError, match="a.zip/take.bvh: cannot be unpacked"):
        file.read()


def test_a_file_that_went_away_is_named(tmp_path):
    with pytest.raises(InputFileError, match="gone.bvh: cannot be read"):
        MotionFile.from_path(tmp_path / "gone.bvh").read()


@pytest.mark.parametrize(
    ("head", "is_one"),
    [(FRAMES[:200], True), (b'{"a": 1}', False), (b'"Frames"', False), (b"", False), (b"[1]", False)],
)
def test_deepmimics_files_are_told_by_how_they_begin(head, is_one):
    assert is_deepmimic(head) == is_one
