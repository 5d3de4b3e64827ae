"""Which clips of a library are learned from or tested on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from unicon.errors import UniconError
from unicon.motion.catalogue.subsets import subset
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary


@dataclass(frozen=True)
class DatasetConfig:
    """A choice among the clips of a library."""

    name: str = "All"
    """Sub-dataset of the paper: All, RunJumpWalk, Casual, SportDance, Animal or Walk."""
    split: Literal["train", "test", "both"] = "train"
    """train has the clips of no split, too."""
    clips: tuple[str, ...] = ()
    """Only these clips by name, whatever the rest says; none: all that the rest lets through."""
    keep_marks: tuple[str, ...] = ()
    """Marks that do not keep a clip out, e.g. uneven_ground; a clip with any other mark stays out."""
    min_seconds: float = 0.5
    """Shorter clips stay out [s]."""


class Dataset(NamedTuple):
    """The chosen clips."""

    library: ClipLibrary
    rows: np.ndarray
    """Their places in the library's ``infos`` ``(C,)``."""

    @property
    def infos(self) -> list[ClipInfo]:
        """What the library knows of them."""
        return [self.library.infos[row] for row in self.rows]

    @property
    def lengths(self) -> np.ndarray:
        """Their numbers of frames ``(C,)``."""
        return self.library.lengths[self.rows]


def choose_clips(library: ClipLibrary, config: DatasetConfig = DatasetConfig()) -> Dataset:  # noqa: B008
    """Return the clips of a library that a choice lets through.

    Raises:
        UnknownNameError: when there is no such sub-dataset or clip.
        UniconError: when no clip is left.
    """
    if config.clips:
        return Dataset(library, np.array([library.row(name) for name in config.clips]))
    part, kept = subset(config.name), set(config.keep_marks)
    rows = [
        row
        for row, info in enumerate(library.infos)
        if part.holds(info)
        and _is_in_split(info, config.split)
        and set(info.marks) <= kept
        and info.seconds >= config.min_seconds
    ]
    if not rows:
        raise UniconError(
            f"{library.folder}: none of its {len(library)} clips is in {part.name} and in the split "
            f"{config.split}, without marks and of {config.min_seconds} s or more; choose another "
            "sub-dataset, or import more motions"
        )
    return Dataset(library, np.array(rows))


def _is_in_split(info: ClipInfo, split: str) -> bool:
    return split == "both" or (info.split == "test") == (split == "test")
