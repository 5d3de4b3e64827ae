"""Tests for array_file.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.errors import InputFileError
from unicon.motion.formats.array_file import Arrays, list_arrays
from unicon.motion.formats.motion_file import MotionFile


@pytest.fixture
def arrays(tmp_path) -> Arrays:
    path = tmp_path / "a.npz"
    np.savez_compressed(
        path, a=np.ones((2, 3), np.float32), n=np.array(29, np.int32), bad=[1.0, np.nan], names=["x"]
    )
    assert list_arrays(MotionFile.from_path(path)) == ["a", "n", "bad", "names"]
    return Arrays(MotionFile.from_path(path))


def test_numbers_come_as_float64_in_the_shape_that_was_asked_for(arrays):
    assert arrays.numbers("a", (None, 3)).dtype == np.float64
    assert arrays.numbers("n", ()) == 29.0
    assert "a" in arrays
    assert "b" not in arrays


@pytest.mark.parametrize(
    ("name", "shape", "said"),
    [
        ("b", (2,), "has no array 'b'; it has a, n, bad, names"),
        ("a", (2, 4), r"'a' has the shape \(2, 3\), expected 2 x 4"),
        ("a", (None,), r"'a' has the shape \(2, 3\), expected any"),
        ("a", (), r"'a' has the shape \(2, 3\), expected one number"),
        ("bad", (2,), "'bad' holds something that is not a finite number"),
        ("names", (1,), "'names' holds something that is not a finite number"),
    ],
)
def test_what_does_not_fit_is_named(arrays, name, shape, said):
    with pytest.raises(InputFileError, match=f"a.npz: {said}"):
        arrays.numbers(name, shape)


def test_objects_are_never_unpickled(tmp_path):
    np.savez(tmp_path / "a.npz", a=np.array([{"x": 1}], dtype=object))
    with pytest.raises(InputFileError, match="a.npz: is no whole .npz file of plain arrays"):
        Arrays(MotionFile.from_path(tmp_path / "a.npz"))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut", b"text"])
def test_what_is_no_such_file_is_named(tmp_path, content):
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(InputFileError, match="a.npz: is no whole .npz file"):
        list_arrays(MotionFile.from_path(tmp_path / "a.npz"))


def test_a_packing_that_is_not_known_is_named(tmp_path, arrays):
    content = (tmp_path / "a.npz").read_bytes()
    where = content.index(b"PK\x01\x02") + 10
    (tmp_path / "a.npz").write_bytes(content[:where] + b"\x63" + content[where + 1 :])
    with pytest.raises(InputFileError, match="a.npz: is no whole .npz file"):
        Arrays(MotionFile.from_path(tmp_path / "a.npz"))


def test_a_single_array_is_no_such_file(tmp_path):
    with (tmp_path / "a.npz").open("wb") as file:
        np.save(file, np.ones(3))
    with pytest.raises(InputFileError, match="a single array without a name"):
        Arrays(MotionFile.from_path(tmp_path / "a.npz"))
