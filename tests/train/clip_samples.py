"""A small library for tests of evaluations."""

from __future__ import annotations

from pathlib import Path

from tests.samples import swaying_clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter

CLASSES = {
    "stroll": ("walking/slow", "train", 60, 0.1),
    "march": ("walking/fast", "test", 45, 0.8),
    "sway": ("standing", "test", 90, 0.0),
    "lean": ("standing", "train", 40, 0.05),
}


def small_library(folder: Path) -> ClipLibrary:
    """Write four clips of three classes, two on each side of the split, and one that is marked."""
    with LibraryWriter(folder) as writer:
        for name, (label, split, frames, speed) in CLASSES.items():
            info = ClipInfo(name, frames, label, split=split)
            writer.add(info, swaying_clip(frames, speed, name).frames)
        writer.add(
            ClipInfo("stairs", 60, "walking/stairs", marks=("uneven_ground",)), swaying_clip(60).frames
        )
        writer.commit()
    return ClipLibrary(folder)
