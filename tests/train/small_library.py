"""A clip library of a few short clips, and which simulators this machine has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.samples import swaying_clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter
from unicon.train.environment.batch_simulator.build import NoCompilerError, find_compiler
from unicon.train.environment.dataset import Dataset, choose_clips

CLIPS = (
    ClipInfo("walk_a", 90, "walking/forward"),
    ClipInfo("walk_b", 75, "walking/forward", split="train"),
    ClipInfo("dance", 60, "dance", split="train"),
    ClipInfo("walk_test", 60, "walking/forward", split="test"),
    ClipInfo("stairs", 60, "walking/forward", split="train", marks=("uneven_ground",)),
    ClipInfo("blink", 8, "dance", split="train"),
)


def make_library(folder: Path) -> ClipLibrary:
    with LibraryWriter(folder) as writer:
        for row, info in enumerate(CLIPS):
            writer.add(info, swaying_clip(info.frames, speed=0.1 * (row + 1)).frames)
        writer.commit()
    return ClipLibrary(folder)


def make_dataset(folder: Path) -> Dataset:
    """Three clips: walk_a, walk_b and dance."""
    return choose_clips(make_library(folder))


def _has_compiler() -> bool:
    try:
        find_compiler()
    except NoCompilerError:
        return False
    return True


SIMULATORS = (
    "mujoco",
    pytest.param("batch", marks=pytest.mark.skipif(not _has_compiler(), reason="no C++ compiler")),
)
