"""The clip library: thousands of clips that open at once and are read when they are used.

A library, version 1, is a folder with

- ``index.json``: version, humanoid, rate, the columns of a frame, and one row a clip
  (``ClipInfo`` and the number of its first frame);
- ``frames-<hash>.npy``: the frames of all clips, one after the other in the order of the rows,
  ``(F, 83)`` float32: root position and rotation, 35 hinge angles, then the velocities of the same.
  It is mapped into memory, never loaded, and cannot be written to.

The index names the file of the frames, so replacing the index replaces the library in one step.
``LibraryWriter`` makes libraries; a single clip in a file of its own is ``Clip.save``'s matter.
"""

from __future__ import annotations

import difflib
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError, UnknownNameError
from unicon.motion.clip import Clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library_index import COLUMNS, INDEX_FILE, WIDTH, read_index
from unicon.state import CharacterState


class ClipLibrary:
    """Clips by name.

    Raises:
        InputFileError: when the folder is no library, or one that cannot be used here.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        index = read_index(self.folder)
        self.infos: tuple[ClipInfo, ...] = index.infos
        """One row a clip, in the order of the frames."""
        self.lengths = _read_only(np.array([info.frames for info in index.infos], dtype=np.int64))
        """Number of frames of each row ``(C,)``."""
        self.first_frames = _read_only(np.cumsum(self.lengths) - self.lengths)
        """Where each row begins among the frames ``(C,)``."""
        self.frames_file = index.frames_file
        """Name of the file with the frames."""
        self.array = _map_frames(self.folder, index.frames_file, index.frame_count)
        """All frames ``(F, 83)``, float32, mapped into memory and read-only."""

    def __len__(self) -> int:
        return len(self.infos)

    def __contains__(self, name: str) -> bool:
        return name in self._rows

    @cached_property
    def _rows(self) -> dict[str, int]:
        return {info.name: row for row, info in enumerate(self.infos)}

    @property
    def names(self) -> list[str]:
        """All names, in alphabetical order."""
        return sorted(self._rows)

    def row(self, name: str) -> int:
        """Return a clip's place in ``infos``.

        Raises:
            UnknownNameError: when there is none of that name; the message lists the nearest.
        """
        if name not in self._rows:
            near = difflib.get_close_matches(name, self._rows, n=5, cutoff=0.3) or self.names[:5]
            raise UnknownNameError(f"there is no motion {name!r}; the nearest are {', '.join(near)}")
        return self._rows[name]

    def info(self, name: str) -> ClipInfo:
        """Return what is known of a clip without reading it.

        Raises:
            UnknownNameError: when there is none of that name.
        """
        return self.infos[self.row(name)]

    def get(self, name: str) -> Clip:
        """Return a clip, in float64.

        Raises:
            UnknownNameError: when there is none of that name; the message lists the nearest.
        """
        row = self.row(name)
        first = self.first_frames[row]
        values = vars(self.frames(slice(first, first + self.lengths[row])))
        frames = {key: np.array(value, dtype=np.float64) for key, value in values.items()}
        frames["root_quat_w"] = rotations.normalize(frames["root_quat_w"])
        info = self.infos[row]
        return Clip(name, CharacterState(**frames), info.source, info.licence, info.label)

    def frames(self, indices: Any) -> CharacterState:
        """Return frames by their numbers among all frames ``(...)``, float32.

        With a slice they are read-only views of the file; with an array they are copies.
        """
        return as_states(self.array[indices])


def as_states(rows: np.ndarray) -> CharacterState:
    """Return rows ``(..., 83)`` of a library as states: views of the same memory."""
    fields, first = {}, 0
    for name, width in COLUMNS.items():
        fields[name] = rows[..., first : first + width]
        first += width
    return CharacterState(**fields)


def as_rows(frames: CharacterState) -> np.ndarray:
    """Return states ``(T,)`` as rows ``(T, 83)``, float32."""
    return np.concatenate([getattr(frames, name) for name in COLUMNS], axis=-1).astype(np.float32)


def _map_frames(folder: Path, name: str, count: int) -> np.ndarray:
    path = folder / name
    try:
        frames = np.load(path, mmap_mode="r", allow_pickle=False)
    except FileNotFoundError:
        raise InputFileError(
            f"{path}: is missing, though {INDEX_FILE} names it; import the motions again"
        ) from None
    except (OSError, ValueError, EOFError) as error:
        raise InputFileError(f"{path}: cannot be used ({error}); import the motions again") from error
    if frames.shape != (count, WIDTH) or frames.dtype != np.float32:
        raise InputFileError(
            f"{path}: holds {frames.dtype} {frames.shape}, expected float32 {(count, WIDTH)} as "
            f"{INDEX_FILE} says; import the motions again"
        )
    return np.asarray(frames)  # a plain view: what is computed with it is no memmap either


def _read_only(array: np.ndarray) -> np.ndarray:
    array.flags.writeable = False
    return array
