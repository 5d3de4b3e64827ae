"""`make bench-motions`: how fast the motion library is, beside other programs that do the same.

Opens a library of 3,000 clips; draws batches of start frames with their targets; retargets BVH files in
closed form and, with the same model and error measure, frame by frame with mink's inverse kinematics as
GMR does; reads BVH with our reader, bvhio and upc-pymotion. Competitors take turns and medians count.
Writes out/bench/motions_speed.json.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import tyro
from bvh_readers import PEERS, measure_readers
from library_speed import LibraryConfig, measure_library
from mink_retargeting import MinkConfig
from retargeting import measure_retargeting
from rich.console import Console
from rich.markup import escape
from rich.progress import Progress
from rich.table import Table

from unicon.errors import InputFileError, UniconError
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.bvh_export import write_bvh
from unicon.motion.formats.motion_file import MotionFile, find_motion_files
from unicon.motion.retargeting.skeletons import recognise
from unicon.motion.source_motion import SourceMotion
from unicon.motion.store.library_choice import open_library

EDGE_SHARE = 0.05
"""Part of a file at either end that is left out: some begin or end with a T-pose."""

SPEEDS = {
    "retargeting [frames/s a core]": "frames_per_s",
    "and grounding [frames/s a core]": "with_ground_frames_per_s",
}
ERRORS = {
    "mean error [mm]": "mean_error_mm",
    "99th percentile [mm]": "p99_error_mm",
    "worst error [mm]": "worst_error_mm",
    "fastest hinge [rad/s]": "worst_hinge_velocity_rad_per_s",
}
"""Rows of the table by label."""

Item = TypeVar("Item")


@dataclass(frozen=True)
class BenchConfig:
    """What to measure, and where to write."""

    motions: tuple[Path, ...] = ()
    """BVH files, folders or zip archives; without any, the clips of the default library, exported."""
    files: int = 8
    """Most BVH files to use, spread evenly over those there are."""
    frames: int = 2000
    """Most frames at 60 Hz to retarget, over all files."""
    turns: int = 3
    """How often each competitor does each file; the median counts."""
    library: LibraryConfig = field(default_factory=LibraryConfig)
    mink: MinkConfig = field(default_factory=MinkConfig)
    out: Path = Path("out/bench/motions_speed.json")


def spread(items: Sequence[Item], count: int) -> list[Item]:
    """Return at most ``count`` items, evenly spaced."""
    places = np.linspace(0, len(items) - 1, min(count, len(items))).round().astype(int)
    return [items[place] for place in places]


def gather_files(config: BenchConfig, folder: Path, console: Console) -> list[MotionFile]:
    """Return the BVH files to use, each one copied or exported into a folder of its own.

    Raises:
        UniconError: when there are none that can be used.
    """
    files = named_files(config.motions) if config.motions else exported_files(config.files, folder, console)
    usable = []
    for file in spread(files, config.files):
        try:
            copy = folder / f"{len(usable):02d}.bvh"
            copy.write_bytes(file.read())
            recognise(read_bvh(replace(file, path=copy, member="")))
        except InputFileError as error:
            console.print(f"left out: {error}", markup=False)
        else:
            usable.append(replace(file, path=copy, member=""))
    if not usable:
        raise UniconError("none of the BVH files can be used; name others with --motions")
    return usable


def named_files(paths: Iterable[Path]) -> list[MotionFile]:
    """Return the BVH files at paths.

    Raises:
        UniconError: when there are none.
    """
    files = [file for file in find_motion_files(paths) if file.suffix == ".bvh"]
    if not files:
        raise UniconError("there are no BVH files there; name a folder or archive with some with --motions")
    return files


def exported_files(count: int, folder: Path, console: Console) -> list[MotionFile]:
    """Write clips of the default library as BVH files."""
    library = open_library(None, console)
    paths = []
    for name in spread(library.names, count):
        paths.append(folder / "exported" / f"{name}.bvh")
        write_bvh(library.get(name).frames, paths[-1])
    return [MotionFile.from_path(path) for path in paths]


def middle_part(motion: SourceMotion, seconds: float) -> SourceMotion:
    """Return the middle of a motion, at most so long [s]."""
    times = motion.times_s - motion.times_s[0]
    reach = min(0.5 * seconds, (0.5 - EDGE_SHARE) * times[-1])
    kept = np.abs(times - 0.5 * times[-1]) <= reach
    local = None if motion.local_pos is None else motion.local_pos[kept]
    return replace(
        motion,
        times_s=times[kept],
        root_pos=motion.root_pos[kept],
        local_quat=motion.local_quat[kept],
        local_pos=local,
    )


def measure(config: BenchConfig, folder: Path, console: Console) -> dict[str, object]:
    """Return all figures."""
    files = gather_files(config, folder, console)
    seconds = (config.frames / len(files) - 1) / RATE_HZ
    motions = [middle_part(read_bvh(file), seconds) for file in files]
    figures: dict[str, object] = {
        "cores": os.cpu_count(),
        "bvh_files": [file.name for file in files] if config.motions else "default library, exported",
    }
    parts = {
        "library": lambda: measure_library(config.library),
        "retargeting": lambda: measure_retargeting(motions, config.turns, config.mink),
        "bvh_reading": lambda: measure_readers(files, config.turns),
    }
    with Progress(console=console) as progress:
        task = progress.add_task("", total=len(parts))
        for name, part in parts.items():
            progress.update(task, description=name.replace("_", " "))
            figures[name] = part()
            progress.advance(task)
    return figures


def to_table(config: BenchConfig, figures: dict) -> Table:
    """Return the figures side by side; ratios are how often faster ours is, and our error over theirs."""
    table = Table("", "ours", "beside", "ratio", title="motion library")
    for column in table.columns[1:]:
        column.justify = "right"
    rows = [*_library_rows(config.library, figures["library"])]
    rows += [*_fitting_rows(figures["retargeting"]), *_reading_rows(figures["bvh_reading"])]
    for label, *cells in rows:
        table.add_row(escape(label), *cells)
    return table


def _library_rows(config: LibraryConfig, figures: dict[str, float]) -> Iterator[tuple[str, ...]]:
    yield (
        f"opening {figures['clips']} clips [ms]",
        f"{1000 * figures['open_s']:.0f}",
        f"{1000 * figures['open_core_s']:.0f} of a core",
    )
    for tau in config.taus:
        clock, core = (figures[f"sample_{config.batch}_tau_{tau}_{key}"] for key in ("ms", "core_ms"))
        yield f"{config.batch} start frames, tau {tau} [ms]", f"{clock:.2f}", f"{core:.2f} of a core"


def _fitting_rows(figures: dict) -> Iterator[tuple[str, ...]]:
    ours, mink = figures["ours"], figures["mink"]
    for label, key in SPEEDS.items():
        ratio = ours[key] / mink["frames_per_s"]
        yield label, f"{ours[key]:.0f}", f"mink {mink['frames_per_s']:.0f}", f"{ratio:.1f} x"
    for label, key in ERRORS.items():
        yield label, f"{ours[key]:.1f}", f"mink {mink[key]:.1f}", f"{ours[key] / mink[key]:.2f}"


def _reading_rows(figures: dict[str, float]) -> Iterator[tuple[str, ...]]:
    ours = f"{figures['ours_frames_per_s']:.0f}"
    for peer in PEERS:
        theirs = f"{peer} {figures[f'{peer}_frames_per_s']:.0f}"
        yield "reading BVH [frames/s a core]", ours, theirs, f"{figures[f'times_{peer}']:.1f} x"
        difference = f"{figures[f'largest_difference_to_{peer}_mm']:.4f}"
        yield "distance of its joints [mm]", difference


def main() -> int:
    """Measure and write the figures; return the exit status."""
    config = tyro.cli(BenchConfig, prog="make bench-motions", description=__doc__)
    console = Console()
    try:
        with tempfile.TemporaryDirectory() as folder:
            figures = measure(config, Path(folder), console)
    except UniconError as error:
        print(f"bench-motions: {error}", file=sys.stderr)
        return 2
    console.print(to_table(config, figures))
    config.out.parent.mkdir(parents=True, exist_ok=True)
    config.out.write_text(json.dumps(figures, indent=2) + "\n")
    console.print(f"written to {config.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
