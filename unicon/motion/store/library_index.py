"""The index of a clip library: a JSON file with one line a clip, and which file holds the frames."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import RATE_HZ, ClipInfo

FORMAT = "unicon clip library"
LIBRARY_VERSION = 1
"""Raised whenever an older program could not read what is written now, or the other way round."""
INDEX_FILE = "index.json"

COLUMNS = {
    "root_pos_w": 3,
    "root_quat_w": 4,
    "joint_pos": len(HUMANOID.joint_names),
    "root_lin_vel_w": 3,
    "root_ang_vel_w": 3,
    "joint_vel": len(HUMANOID.joint_names),
}
"""The fields of a CharacterState in the order in which they stand in a row, with their widths."""
WIDTH = sum(COLUMNS.values())
POSE_WIDTH = 7 + len(HUMANOID.joint_names)
"""The velocities begin here."""


@dataclass(frozen=True)
class LibraryIndex:
    """What the index says."""

    infos: tuple[ClipInfo, ...]
    """One a clip; their frames lie one after the other in this order."""
    frames_file: str
    """Name of the file with the frames, in the same folder."""

    @property
    def frame_count(self) -> int:
        """Number of frames of all clips."""
        return sum(info.frames for info in self.infos)


def is_library(folder: Path) -> bool:
    """Say whether a folder has the index of a library."""
    return (folder / INDEX_FILE).is_file()


def write_index(folder: Path, index: LibraryIndex) -> None:
    """Replace a library's index at once: a reader sees the old one or the new one.

    Raises:
        OSError: when it cannot be written.
    """
    head = {
        "format": FORMAT,
        "version": LIBRARY_VERSION,
        "humanoid_id": HUMANOID.id,
        "rate_hz": RATE_HZ,
        "columns": COLUMNS,
        "frames_file": index.frames_file,
        "frame_count": index.frame_count,
    }
    rows, first = [], 0
    for info in index.infos:
        rows.append(json.dumps({"first_frame": first, **info_to_json(info)}, ensure_ascii=False))
        first += info.frames
    text = json.dumps(head, indent=1)[:-2] + ',\n "clips": [\n' + ",\n".join(rows) + "\n]}\n"
    replace_file(folder / INDEX_FILE, text)


def replace_file(path: Path, text: str) -> None:
    """Write a file so that a crash leaves either the old one or the new one.

    Raises:
        OSError: when it cannot be written.
    """
    temporary = path.with_name(f".{path.name}.new")
    with temporary.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(path)


def read_index(folder: Path) -> LibraryIndex:
    """Read a library's index.

    Raises:
        InputFileError: when there is none, or it is damaged, of another version or for another humanoid.
    """
    path = folder / INDEX_FILE
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        raise InputFileError(_explain_missing(folder)) from None
    except (OSError, ValueError) as error:
        raise InputFileError(f"{path}: cannot be read ({error}); import the motions again") from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise InputFileError(f"{path}: is not the index of a clip library; expected format {FORMAT!r}")
    _check_head(path, content)
    try:
        infos = tuple(info_from_json(row) for row in content["clips"])
        index = LibraryIndex(infos, content["frames_file"])
    except (KeyError, TypeError, ValueError) as error:
        raise InputFileError(
            f"{path}: a clip's row is damaged ({error!r}); import the motions again"
        ) from error
    if index.frame_count != content.get("frame_count"):
        raise InputFileError(
            f"{path}: its clips have {index.frame_count} frames, expected {content.get('frame_count')}; "
            "import the motions again"
        )
    return index


def _check_head(path: Path, content: dict[str, Any]) -> None:
    expected = {
        "version": LIBRARY_VERSION,
        "humanoid_id": HUMANOID.id,
        "rate_hz": RATE_HZ,
        "columns": COLUMNS,
    }
    for key, value in expected.items():
        if content.get(key) != value:
            raise InputFileError(
                f"{path}: has the {key} {content.get(key)!r}, expected {value!r}; import the motions again "
                "into a new folder"
            )


def _explain_missing(folder: Path) -> str:
    if not folder.is_dir():
        return (
            f"{folder}: there is no such clip library; make one with `unicon motions import` "
            "or `unicon motions fetch`"
        )
    if any(folder.glob("*.npz")):
        return (
            f"{folder}: holds single clips, not a clip library; make one of them with "
            f"`unicon motions import {folder} --out LIBRARY`"
        )
    return (
        f"{folder}: is not a clip library (it has no {INDEX_FILE}); make one with `unicon motions import` "
        "or `unicon motions fetch`"
    )


def info_to_json(info: ClipInfo) -> dict[str, Any]:
    """Return a row without the fields that have their defaults; figures that are not finite become null."""
    defaults = {field.name: field.default for field in fields(ClipInfo)}
    row = {name: value for name, value in vars(info).items() if value != defaults[name]}
    row["quality"] = {
        name: float(value) if math.isfinite(value) else None for name, value in info.quality.items()
    }
    return row


def info_from_json(row: dict[str, Any]) -> ClipInfo:
    """Read a row back.

    Raises:
        TypeError: when it has other fields.
    """
    row = {**row, "marks": tuple(row.get("marks", ()))}
    row.pop("first_frame", None)
    quality = row.get("quality", {})
    if None in quality.values():
        row["quality"] = {name: math.nan if value is None else value for name, value in quality.items()}
    return ClipInfo(**row)
