"""Tests for library.py."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.samples import swaying_clip
from unicon.errors import InputFileError, UnknownNameError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary, as_rows, as_states
from unicon.motion.store.library_writer import LibraryWriter


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_library(tmp_path / "library", {"walk": 90, "run": 60, "jump": 2})


def write_library(folder: Path, lengths: dict[str, int]) -> Path:
    with LibraryWriter(folder) as writer:
        for name, count in lengths.items():
            writer.add_clip(swaying_clip(count, name=name))
        writer.commit()
    return folder


def edit_index(folder: Path, **changes: object) -> None:
    content = json.loads((folder / "index.json").read_text())
    (folder / "index.json").write_text(json.dumps({**content, **changes}))


def test_a_clip_comes_back_as_it_was_within_single_precision(folder):
    clip = ClipLibrary(folder).get("walk")
    expected = swaying_clip(90, name="walk")
    assert (clip.name, clip.label, len(clip)) == ("walk", "test", 90)
    for name, value in vars(expected.frames).items():
        assert getattr(clip.frames, name).dtype == np.float64
        assert np.allclose(getattr(clip.frames, name), value, atol=1e-5), name


@settings(max_examples=25, deadline=None)
@given(
    lengths=st.lists(st.integers(2, 9), min_size=1, max_size=4),
    seed=st.integers(0, 2**32 - 1),
    label=st.text(max_size=8),
    quality=st.dictionaries(st.text(max_size=5), st.floats(allow_infinity=False), max_size=3),
)
def test_whatever_is_written_is_read_back(tmp_path_factory, lengths, seed, label, quality):
    folder = tmp_path_factory.mktemp("library")
    rng = np.random.default_rng(seed)
    rows = [rng.standard_normal((count, 83)).astype(np.float32) for count in lengths]
    infos = [
        ClipInfo(
            f"clip {k}", len(part), label, f"take{k}", origin="a.zip/b", marks=("prop",), quality=quality
        )
        for k, part in enumerate(rows)
    ]
    with LibraryWriter(folder) as writer:
        for info, part in zip(infos, rows, strict=True):
            writer.add(info, as_states(part))
        writer.commit()
    library = ClipLibrary(folder)
    assert repr(library.infos) == repr(tuple(infos))
    for row, part in enumerate(rows):
        first = library.first_frames[row]
        frames = library.frames(slice(first, first + len(part)))
        assert np.array_equal(as_rows(frames), part)


def test_the_frames_of_the_library_cannot_be_written_to(folder):
    library = ClipLibrary(folder)
    with pytest.raises(ValueError, match="read-only"):
        library.array[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        library.frames(slice(0, 5)).joint_pos[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        library.first_frames[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        library.get("walk").frames.joint_pos[0] = 1.0


def test_frames_are_mapped_and_not_loaded(folder):
    library = ClipLibrary(folder)
    assert isinstance(library.array.base, np.memmap)
    assert np.shares_memory(library.frames(slice(3, 6)).joint_vel, library.array)


def test_frames_are_gathered_by_their_numbers(folder):
    library = ClipLibrary(folder)
    indices = np.array([[0, 90], [150, 151]])
    states = library.frames(indices)
    assert states.batch_shape == (2, 2)
    assert np.array_equal(states.root_pos_w[0, 1], library.array[90, :3])
    jump = library.get("jump").frames
    assert np.allclose(states.joint_pos[1], jump.joint_pos, atol=1e-6)


def test_rows_begin_where_the_last_one_ended(folder):
    library = ClipLibrary(folder)
    assert [info.name for info in library.infos] == ["walk", "run", "jump"]
    assert library.first_frames.tolist() == [0, 90, 150]
    assert library.lengths.tolist() == [90, 60, 2]


def test_names_are_in_alphabetical_order_and_the_nearest_are_offered(folder):
    library = ClipLibrary(folder)
    assert library.names == ["jump", "run", "walk"]
    assert "walk" in library and "walkk" not in library
    with pytest.raises(UnknownNameError, match="nearest are walk"):
        library.get("walkk")


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("version", 99, "version 99, expected 1"),
        ("humanoid_id", "another", "'another', expected"),
        ("rate_hz", 30.0, "30.0, expected 60.0"),
        ("columns", {"root_pos_w": 3}, "columns"),
        ("format", "something", "not the index of a clip library"),
        ("frame_count", 7, "have 152 frames, expected 7"),
        ("clips", [{"name": "walk"}], "row is damaged"),
        ("frames_file", "frames-none.npy", "is missing"),
    ],
)
def test_a_library_that_cannot_be_used_says_why(folder, key, value, expected):
    edit_index(folder, **{key: value})
    with pytest.raises(InputFileError, match=expected) as caught:
        ClipLibrary(folder)
    assert str(folder) in str(caught.value)


def test_truncated_frames_are_named(folder):
    (path,) = folder.glob("frames-*.npy")
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(InputFileError, match=f"{path.name}: cannot be used"):
        ClipLibrary(folder)


def test_an_index_that_is_cut_off_is_named(folder):
    path = folder / "index.json"
    path.write_text(path.read_text()[:-20])
    with pytest.raises(InputFileError, match=r"index.json: cannot be read .* import the motions again"):
        ClipLibrary(folder)


def test_an_empty_or_missing_folder_is_no_library(tmp_path):
    for folder in (tmp_path, tmp_path / "none"):
        with pytest.raises(InputFileError, match="motions import"):
            ClipLibrary(folder)


def test_a_folder_of_single_clips_says_how_to_make_a_library_of_it(tmp_path):
    swaying_clip().save(tmp_path / "sway.npz")
    with pytest.raises(InputFileError, match=f"motions import {tmp_path} --out LIBRARY"):
        ClipLibrary(tmp_path)
