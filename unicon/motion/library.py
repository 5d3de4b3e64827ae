"""A folder of clips."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from pathlib import Path

from unicon.errors import InputFileError, UnknownNameError
from unicon.motion.clip import Clip, load_clip


@dataclass(frozen=True)
class ClipLibrary:
    """All ``*.npz`` clips of a folder, by name; a clip is read when it is asked for."""

    folder: Path

    def __post_init__(self) -> None:
        if not self.folder.is_dir():
            raise InputFileError(
                f"{self.folder}: there is no such folder of clips; run `unicon motions fetch`"
            )
        if not self.names:
            raise InputFileError(f"{self.folder}: holds no clips (*.npz); run `unicon motions fetch`")

    @property
    def names(self) -> list[str]:
        """All names, in alphabetical order."""
        return sorted(path.stem for path in self.folder.glob("*.npz"))

    def get(self, name: str) -> Clip:
        """Return a clip.

        Raises:
            UnknownNameError: when there is none of that name; the message lists the nearest.
            InputFileError: when its file cannot be used.
        """
        if name not in self.names:
            near = difflib.get_close_matches(name, self.names, n=5, cutoff=0.3) or self.names[:5]
            raise UnknownNameError(f"there is no motion {name!r}; the nearest are {', '.join(near)}")
        return load_clip(self.folder / f"{name}.npz")
