"""Writes a clip library clip by clip, and puts it in the old one's place in one step."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

import numpy as np

from unicon.errors import UniconError
from unicon.motion.clip import Clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary, as_rows
from unicon.motion.store.library_index import WIDTH, LibraryIndex, write_index
from unicon.state import CharacterState

FRAMES_PATTERN = "frames-*.npy"
_UNFINISHED = ".frames.npy.new"


class LibraryWriter:
    """Collects clips beside the library of a folder; ``commit`` replaces it, and a crash before leaves it.

    Use it as a context: leaving it without ``commit`` removes what was collected.

    Raises:
        UniconError: when the folder cannot be written or the disk is full.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._infos: list[ClipInfo] = []
        self._names: set[str] = set()
        self._hash = hashlib.sha256()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file: BinaryIO = (folder / _UNFINISHED).open("w+b")
            self._write_header(0)
        except OSError as error:
            raise _cannot_write(folder, error) from error

    def __enter__(self) -> LibraryWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with suppress(OSError):  # a full disk shows again when the rest of the buffer is written
            self._file.close()
        (self.folder / _UNFINISHED).unlink(missing_ok=True)

    def add(self, info: ClipInfo, frames: CharacterState) -> None:
        """Append a clip of frames ``(T,)``; its row takes their number.

        Raises:
            ValueError: when its name is taken, or it has fewer than 2 frames.
            UniconError: when the disk is full.
        """
        self.add_rows(info, as_rows(frames))

    def add_rows(self, info: ClipInfo, rows: np.ndarray) -> None:
        """Append a clip of rows ``(T, 83)`` as a library has them.

        Raises:
            ValueError: when its name is taken, its rows have another width, or it has fewer than 2.
            UniconError: when the disk is full.
        """
        if info.name in self._names:
            raise ValueError(f"there is already a clip {info.name!r}")
        if rows.ndim != 2 or rows.shape[1] != WIDTH or len(rows) < 2:
            raise ValueError(f"a clip needs at least 2 rows of {WIDTH}, got {rows.shape}")
        data = np.ascontiguousarray(rows, dtype="<f4").tobytes()
        try:
            self._file.write(data)
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        self._hash.update(data)
        self._names.add(info.name)
        self._infos.append(replace(info, frames=len(rows)))

    def add_clip(self, clip: Clip) -> None:
        """Append a clip with what it knows of itself.

        Raises:
            ValueError, UniconError: as ``add``.
        """
        label = clip.label or "other"
        info = ClipInfo(clip.name, len(clip), label, clip.name, clip.source, clip.licence)
        self.add(info, clip.frames)

    def commit(self) -> None:
        """Make what was collected the library of the folder.

        Raises:
            UniconError: when it cannot be written; the old library stays.
        """
        name = f"frames-{self._hash.hexdigest()[:16]}.npy"
        index = LibraryIndex(tuple(self._infos), name)
        try:
            self._write_header(index.frame_count)
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()
            (self.folder / _UNFINISHED).replace(self.folder / name)
            write_index(self.folder, index)
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        for old in self.folder.glob(FRAMES_PATTERN):
            if old.name != name:
                old.unlink(missing_ok=True)

    def _write_header(self, count: int) -> None:
        """Write the header of an array of ``count`` rows; numpy leaves room in it for the number to grow."""
        self._file.seek(0)
        header = {"descr": "<f4", "fortran_order": False, "shape": (count, WIDTH)}
        np.lib.format.write_array_header_1_0(self._file, header)


def replace_infos(library: ClipLibrary, infos: Sequence[ClipInfo]) -> None:
    """Replace what a library says of its clips, e.g. their split; the frames stay.

    Raises:
        ValueError: when the rows are not those of the library, in its order.
        UniconError: when the index cannot be written; the old one stays.
    """
    if [(i.name, i.frames) for i in infos] != [(i.name, i.frames) for i in library.infos]:
        raise ValueError("the rows have to be those of the library, in its order")
    try:
        write_index(library.folder, LibraryIndex(tuple(infos), library.frames_file))
    except OSError as error:
        raise _cannot_write(library.folder, error) from error


def _cannot_write(folder: Path, error: OSError) -> UniconError:
    return UniconError(
        f"{folder}: the clip library cannot be written ({error.strerror or error}); "
        "make room or choose another folder"
    )
