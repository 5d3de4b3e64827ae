"""The paper's sub-datasets: which classes each holds, and how large it is beside the paper's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from rich.table import Table

from unicon.errors import UnknownNameError
from unicon.motion.catalogue.class_tree import top_class
from unicon.motion.clip_index import RATE_HZ, ClipInfo


class PaperSize(NamedTuple):
    """What the paper says of one of its sub-datasets; None: not known here."""

    motions: int | None = None
    frames: int | None = None


@dataclass(frozen=True)
class Subset:
    """One of the paper's sub-datasets."""

    name: str
    classes: tuple[str, ...]
    """Classes at the top of the tree that belong to it; empty: all."""
    paper: PaperSize = PaperSize()

    def holds(self, info: ClipInfo) -> bool:
        """Return whether a clip belongs to it."""
        return not self.classes or top_class(info.label) in self.classes


class SubsetSize(NamedTuple):
    """How large a sub-dataset is."""

    name: str
    motions: int
    frames: int
    paper: PaperSize

    @property
    def average(self) -> float:
        """Frames a motion; 0 without motions."""
        return self.frames / self.motions if self.motions else 0.0


# All: 2,758 motions of 752 thousand frames for training and 594 of 187 thousand for the test, as another
# project's notes quote the paper, whose text was not at hand; they give no sizes of the other five.
SUBSETS = (
    Subset("All", (), PaperSize(2758 + 594, 752_000 + 187_000)),
    Subset("RunJumpWalk", ("running", "jumping", "walking")),
    Subset("Casual", ("casual",)),
    Subset("SportDance", ("sport", "dance", "martial", "acrobatics")),
    Subset("Animal", ("animal",)),
    Subset("Walk", ("walking",)),
)
"""Martial arts and acrobatics are sports in the CMU database's own order, so they are in SportDance."""


def subset(name: str) -> Subset:
    """Return a sub-dataset by its name, in any letters.

    Raises:
        UnknownNameError: when there is none.
    """
    for candidate in SUBSETS:
        if candidate.name.lower() == name.lower():
            return candidate
    names = ", ".join(candidate.name for candidate in SUBSETS)
    raise UnknownNameError(f"there is no sub-dataset {name!r}; there are {names}")


def subset_sizes(rows: Sequence[ClipInfo]) -> tuple[SubsetSize, ...]:
    """Return the size of each sub-dataset of a library."""
    sizes = []
    for part in SUBSETS:
        inside = [info.frames for info in rows if part.holds(info)]
        sizes.append(SubsetSize(part.name, len(inside), sum(inside), part.paper))
    return tuple(sizes)


def subsets_as_json(sizes: Sequence[SubsetSize]) -> list[dict[str, object]]:
    """Return the table for a file; what is not known of the paper is null."""
    return [
        {
            "name": size.name,
            "motions": size.motions,
            "frames": size.frames,
            "average_frames": round(size.average, 1),
            "average_seconds": round(size.average / RATE_HZ, 2),
            "paper_motions": size.paper.motions,
            "paper_frames": size.paper.frames,
            "paper_average_frames": _paper_average(size.paper),
        }
        for size in sizes
    ]


def subset_table(sizes: Sequence[SubsetSize]) -> Table:
    """Return the table for a terminal, ours beside the paper's."""
    table = Table(title="Sub-datasets")
    table.add_column("")
    for heading in ("motions", "frames", "average", "paper: motions", "frames", "average"):
        table.add_column(heading, justify="right")
    for size in sizes:
        ours = (f"{size.motions:,}", f"{size.frames:,}", f"{size.average:.0f}")
        paper = (size.paper.motions, size.paper.frames, _paper_average(size.paper))
        table.add_row(size.name, *ours, *("not stated" if n is None else f"{n:,}" for n in paper))
    return table


def _paper_average(paper: PaperSize) -> int | None:
    if paper.motions is None or paper.frames is None:
        return None
    return round(paper.frames / paper.motions)
