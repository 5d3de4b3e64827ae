"""The split of a library: in the rows of its index, and in a file beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.table import Table

from unicon.motion.catalogue.split import SplitSettings, split_clips
from unicon.motion.catalogue.split_file import apply_split, read_split, write_split
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import replace_infos

SPLIT_FILE = "split.yaml"


def divide(
    library: ClipLibrary, settings: SplitSettings, file: Path | None = None, use: Path | None = None
) -> list[ClipInfo]:
    """Divide a library into training and test clips; return its rows with their sides.

    Args:
        library: its index is replaced.
        settings: how to divide.
        file: where to write the split; ``split.yaml`` in the library where None.
        use: a split to take instead of dividing anew.

    Raises:
        UniconError: when a file cannot be read or written, or the split does not fit the library.
    """
    plan = read_split(use) if use else split_clips(library.infos, settings)
    file = file or library.folder / SPLIT_FILE
    infos = apply_split(library.infos, plan, use or file)
    write_split(plan, file)
    replace_infos(library, infos)
    return infos


def settings_of(folder: Path) -> SplitSettings:
    """Return how a library was divided the last time; the defaults where it was not."""
    path = folder / SPLIT_FILE
    return read_split(path).settings if path.exists() else SplitSettings()


def split_table(infos: Sequence[ClipInfo]) -> Table:
    """Return the shares of both sides."""
    table = Table("side", "clips", "frames", "share of frames")
    total = sum(info.frames for info in infos)
    for side in ("train", "test"):
        part = [info.frames for info in infos if info.split == side]
        table.add_row(side, f"{len(part):,}", f"{sum(part):,}", f"{100 * sum(part) / max(total, 1):.1f} %")
    return table
