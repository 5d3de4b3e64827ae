"""What the import made of one source file, kept on disk until the library is written."""

from __future__ import annotations

import json
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library_index import info_from_json, info_to_json


@dataclass(frozen=True)
class ProcessedClip:
    """One clip of a file."""

    info: ClipInfo
    rows: np.ndarray
    """Its frames ``(T, 83)`` as a library has them."""


@dataclass(frozen=True)
class ProcessedFile:
    """All clips of a file, or why there are none."""

    clips: tuple[ProcessedClip, ...] = ()
    family: str = ""
    """Skeleton family of the source."""
    decisions: tuple[str, ...] = ()
    """What cleaning did, and why, in words."""
    refused: str = ""
    """Why it could not be used."""
    retry: bool = False
    """Whether the refusal has to do with the machine, not with the file, so that it is tried again."""
    seconds: float = 0.0
    """Time of one core that it took."""

    def save(self, path: Path) -> None:
        """Write it in one step.

        Raises:
            OSError: when it cannot be written.
        """
        about: dict[str, Any] = {**vars(self), "clips": [info_to_json(clip.info) for clip in self.clips]}
        arrays = {f"rows_{number}": clip.rows for number, clip in enumerate(self.clips)}
        temporary = path.with_name(f".{path.name}.new")
        with temporary.open("wb") as file:
            np.savez(file, about=np.array(json.dumps(about)), **arrays)  # pyright: ignore[reportArgumentType]
        temporary.replace(path)


def load_processed(path: Path) -> ProcessedFile | None:
    """Read it back; None where there is none, or it cannot be read and has to be made again."""
    try:
        with np.load(path, allow_pickle=False) as file:
            about = json.loads(str(file["about"]))
            rows = [file[f"rows_{number}"] for number in range(len(about["clips"]))]
        infos = [info_from_json(row) for row in about["clips"]]
        about["clips"] = tuple(ProcessedClip(*pair) for pair in zip(infos, rows, strict=True))
        about["decisions"] = tuple(about["decisions"])
        return ProcessedFile(**about)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        return None
