"""Named arrays in a .npz file, never unpickled."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np

from unicon.errors import InputFileError
from unicon.motion.formats.motion_file import BROKEN_ARCHIVE, MotionFile


class Arrays:
    """The arrays of a file, taken out by name with the shape that they must have."""

    def __init__(self, file: MotionFile) -> None:
        self.origin = file.origin
        self._arrays: dict[str, np.ndarray] = _load(file, lambda npz: {name: npz[name] for name in npz.files})

    def __contains__(self, name: str) -> bool:
        return name in self._arrays

    def get(self, name: str) -> np.ndarray:
        """Return an array as it is.

        Raises:
            InputFileError: when there is none of this name.
        """
        if name not in self._arrays:
            known = ", ".join(list(self._arrays)[:8])
            raise InputFileError(f"{self.origin}: has no array {name!r}; it has {known}")
        return self._arrays[name]

    def numbers(self, name: str, shape: tuple[int | None, ...]) -> np.ndarray:
        """Return an array of finite numbers as float64; None in the shape stands for any size.

        Raises:
            InputFileError: when it is missing, of another shape, or not finite.
        """
        array = self.get(name)
        sizes = [size if size is not None else found for size, found in zip(shape, array.shape, strict=False)]
        if array.ndim != len(shape) or array.shape != tuple(sizes):
            wanted = " x ".join("any" if size is None else str(size) for size in shape) or "one number"
            raise InputFileError(f"{self.origin}: {name!r} has the shape {array.shape}, expected {wanted}")
        if array.dtype.kind not in "fiu" or not np.isfinite(array).all():
            raise InputFileError(f"{self.origin}: {name!r} holds something that is not a finite number")
        return array.astype(np.float64)


def list_arrays(file: MotionFile) -> list[str]:
    """Return the names of a file's arrays without reading them.

    Raises:
        InputFileError: when it is no such file.
    """
    return _load(file, lambda npz: list(npz.files))


def _load(file: MotionFile, take: Callable[[Any], Any]) -> Any:
    try:
        npz = np.load(io.BytesIO(file.read()), allow_pickle=False)
        if not isinstance(npz, np.lib.npyio.NpzFile):
            raise ValueError("it is a single array without a name")
        with npz:
            return take(npz)
    except (OSError, ValueError, KeyError, *BROKEN_ARCHIVE) as error:
        raise InputFileError(f"{file.origin}: is no whole .npz file of plain arrays ({error})") from error
