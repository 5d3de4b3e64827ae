"""How fast a large clip library opens, and how fast frames are drawn from it."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from timing import Seconds, median_seconds

from unicon.humanoid import HUMANOID
from unicon.motion.catalogue.balancer import MotionBalancer
from unicon.motion.clip_index import ClipInfo
from unicon.motion.grounding.quality import ClipQuality
from unicon.motion.store.frame_sampler import FrameSampler
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_index import WIDTH
from unicon.motion.store.library_writer import LibraryWriter

LABELS = tuple(f"class_{i % 12:02d}/kind_{i:02d}" for i in range(60))
"""Classes of the made-up clips, in two levels."""


@dataclass(frozen=True)
class LibraryConfig:
    """The library to open and draw from; it is made for the occasion and thrown away."""

    clips: int = 3000
    clip_frames: int = 300
    """Mean length of its clips."""
    batch: int = 4096
    """Number of start frames in a batch."""
    taus: tuple[int, ...] = (1, 8)
    """How many target frames follow each start frame."""
    open_turns: int = 9
    sample_turns: int = 100


def measure_library(config: LibraryConfig) -> dict[str, float]:
    """Return the median times of opening a library and of drawing batches from it.

    The library has just been written, so the system still has its file in memory.
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        make_library(config, folder)
        library = ClipLibrary(folder)
        figures: dict[str, float] = {
            "clips": len(library),
            "frames": len(library.array),
        }
        opening = median_seconds(lambda: ClipLibrary(folder), config.open_turns)
        figures |= {"open_s": opening.clock, "open_core_s": opening.core}
        for tau in config.taus:
            name, seconds = f"sample_{config.batch}_tau_{tau}", time_sampling(library, tau, config)
            figures |= {f"{name}_ms": 1000 * seconds.clock, f"{name}_core_ms": 1000 * seconds.core}
    return figures


def make_library(config: LibraryConfig, folder: Path) -> None:
    """Write a library of noise whose index is as long as that of real clips."""
    rng = np.random.default_rng(0)
    lengths = rng.integers(config.clip_frames // 5, 2 * config.clip_frames, config.clips)
    noise = rng.standard_normal((int(lengths.max()), WIDTH)).astype(np.float32)
    with LibraryWriter(folder) as writer:
        for number, length in enumerate(lengths):
            writer.add_rows(_info(number, rng), noise[:length])
        writer.commit()


def time_sampling(library: ClipLibrary, tau: int, config: LibraryConfig) -> Seconds:
    """Return the median times of one batch: start states of the humanoid and ``tau`` targets each."""
    probabilities = MotionBalancer(library.infos).probabilities
    sampler = FrameSampler(library, probabilities=probabilities, offsets=range(tau + 1))
    rng = np.random.default_rng(1)
    batch = sampler.sample(config.batch, rng)
    assert batch.states.joint_pos.shape == (config.batch, tau + 1, len(HUMANOID.joint_names))
    return median_seconds(lambda: sampler.sample(config.batch, rng), config.sample_turns)


def _info(number: int, rng: np.random.Generator) -> ClipInfo:
    return ClipInfo(
        name=f"take_{number:05d}",
        frames=0,
        label=str(rng.choice(LABELS)),
        take=f"take_{number // 2:05d}",
        source="made up to measure the speed of opening, by no performer and at no place",
        licence="CC0-1.0",
        origin=f"archive.zip/folder_{number % 40:02d}/take_{number:05d}.bvh",
        split="train",
        quality={field.name: float(rng.random()) for field in fields(ClipQuality)},
    )
