"""Which clips of a library the network may learn from, and as what: the table of ``takes.yaml``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import yaml

from unicon.errors import InputFileError
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.store.library import ClipLibrary
from unicon.state import CharacterState
from unicon.train.runs.settings import build

TAKES_FILE = Path(__file__).with_name("takes.yaml")


@dataclass(frozen=True)
class TakeEntry:
    """A line of the table."""

    clip: str
    """Name in the library."""
    seconds: tuple[float, float] | None = None
    """Part of the clip; none: all of it."""
    loop: bool = False
    """Whether its steady part is repeated."""
    calm_upper: bool = False
    """Whether its trunk and arms are replaced by the mean of those of walks."""


@dataclass(frozen=True)
class TakeTable:
    """All clips, by what they are good for."""

    standing: tuple[TakeEntry, ...]
    walking: tuple[TakeEntry, ...]
    wandering: tuple[TakeEntry, ...]
    running: tuple[TakeEntry, ...]
    stepping: tuple[TakeEntry, ...]
    backward: tuple[TakeEntry, ...]
    sideways: tuple[TakeEntry, ...]
    turning: tuple[TakeEntry, ...]


def read_takes(path: Path = TAKES_FILE) -> TakeTable:
    """Read a table of takes.

    Raises:
        InputFileError: when it cannot be read or says something else than it should.
    """
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputFileError(f"{path}: cannot be read ({' '.join(str(error).split())})") from error
    return build(TakeTable, values, str(path))


def frames_of(entry: TakeEntry, library: ClipLibrary) -> CharacterState:
    """Return the frames of a take.

    Raises:
        UnknownNameError: when the library has no such clip.
    """
    frames = library.get(entry.clip).frames
    if entry.seconds is None:
        return frames
    first, last = (round(second * RATE_HZ) for second in entry.seconds)
    return frames[first : max(last, first + 2)]
