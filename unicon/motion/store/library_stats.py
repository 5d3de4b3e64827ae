"""`unicon motions stats`: how large and how good a library is."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from unicon.errors import UniconError
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.catalogue.class_tree import OTHER, top_class
from unicon.motion.catalogue.subsets import SubsetSize, subset_sizes, subset_table, subsets_as_json
from unicon.motion.clip_index import RATE_HZ, ClipInfo
from unicon.motion.grounding.solid_shapes import lowest_height
from unicon.motion.importing.import_report import read_report
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_index import replace_file

CHUNK_FRAMES = 20_000


@dataclass(frozen=True)
class LibraryStats:
    """The figures of a library; not a number where nothing was measured."""

    clips: int
    frames: int
    import_seconds: float
    """Wall-clock time of the imports that made it."""
    frames_per_second_per_core: float
    """How many frames a core read, cleaned, retargeted and measured in a second."""
    mean_error_mm: float
    """Distance of joints from the scaled source, mean over frames."""
    penetration_p99_mm: float
    """Depth of the lowest point under the floor, 99th percentile over all frames."""
    skate_mm_per_frame: float
    """Way of a standing foot from frame to frame, mean over frames in contact."""
    other_percent: float
    """Share of clips whose class nobody knows."""

    def to_dict(self) -> dict[str, float | None]:
        """Return the figures for a JSON file: null where nothing was measured."""
        return {name: value if math.isfinite(value) else None for name, value in asdict(self).items()}


def library_stats(library: ClipLibrary) -> LibraryStats:
    """Measure a library."""
    infos = library.infos
    report = read_report(library.folder)
    others = sum(top_class(info.label) == OTHER for info in infos)
    return LibraryStats(
        clips=len(infos),
        frames=int(library.lengths.sum()),
        import_seconds=report.seconds if report.runs else math.nan,
        frames_per_second_per_core=report.frames_per_second_per_core if report.runs else math.nan,
        mean_error_mm=_weighted_mean(infos, "mean_error_mm"),
        penetration_p99_mm=float(np.percentile(_depths_mm(library), 99)),
        skate_mm_per_frame=_weighted_mean(infos, "skate_mm_per_frame", "contact_share"),
        other_percent=100.0 * others / max(len(infos), 1),
    )


def write_stats(stats: LibraryStats, sizes: tuple[SubsetSize, ...], path: Path) -> None:
    """Write the figures and the table of sub-datasets as JSON.

    Raises:
        UniconError: when the file cannot be written.
    """
    content: dict[str, Any] = {**stats.to_dict(), "subsets": subsets_as_json(sizes)}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, json.dumps(content, indent=2) + "\n")
    except OSError as error:
        raise UniconError(f"{path}: cannot be written ({error.strerror}); choose another file") from error


def show_stats(library: ClipLibrary, path: Path | None, console: Console) -> None:
    """Print the figures and the table of sub-datasets; write them where a path is given."""
    with console.status("measuring ..."):
        stats, sizes = library_stats(library), subset_sizes(library.infos)
    table = Table("figure", "value", title=str(library.folder))
    table.columns[1].justify = "right"
    for name, value in stats.to_dict().items():
        text = (
            "not measured" if value is None else f"{value:,}" if isinstance(value, int) else f"{value:,.2f}"
        )
        table.add_row(name.replace("_", " "), text)
    table.add_row("minutes", f"{stats.frames / RATE_HZ / 60:,.1f}")
    console.print(table)
    console.print(subset_table(sizes))
    if path is not None:
        write_stats(stats, sizes, path)
        console.print(str(path))


def _weighted_mean(infos: tuple[ClipInfo, ...], name: str, weight: str = "") -> float:
    """Return a figure's mean over the frames of all clips that have it, times another one's share."""
    pairs = [
        (info.quality[name], info.frames * (info.quality.get(weight, 0.0) if weight else 1.0))
        for info in infos
        if math.isfinite(info.quality.get(name, math.nan))
    ]
    total = sum(weight for _, weight in pairs)
    return sum(value * weight for value, weight in pairs) / total if total else math.nan


def _depths_mm(library: ClipLibrary) -> np.ndarray:
    """Return how far the lowest point of each frame is under the floor ``(F,)``."""
    count = len(library.array)
    depths = []
    for first in range(0, count, CHUNK_FRAMES):
        lowest = lowest_height(forward_kinematics(library.frames(slice(first, first + CHUNK_FRAMES))))
        depths.append(1000.0 * np.maximum(-lowest, 0.0))
    return np.concatenate(depths)
