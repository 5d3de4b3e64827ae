"""What is to be shown: avatar and target over time, from a clip or a recording."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from unicon.errors import InputFileError
from unicon.motion.clip import RATE_HZ, Clip, load_clip
from unicon.motion.store.library_index import is_library
from unicon.recording.bag_reading import read_recording
from unicon.state import CharacterState, stack
from unicon.target_frames import NS_PER_S
from unicon.tracking import Mode


@dataclass(frozen=True)
class Take:
    """T frames at 60 Hz."""

    times_s: np.ndarray
    """``(T,)``, from 0."""
    avatar: CharacterState
    """Batch ``(T,)``."""
    target: CharacterState | None
    """Batch ``(T,)``, None where there is none to show."""
    captions: tuple[str, ...]
    """A few words for each frame."""

    def __getitem__(self, part: slice) -> Take:
        """Return a part of it."""
        target = None if self.target is None else self.target[part]
        return Take(self.times_s[part], self.avatar[part], target, self.captions[part])


def take_from_clip(clip: Clip) -> Take:
    """Show a clip by itself."""
    times_s = np.arange(len(clip)) / RATE_HZ
    return Take(times_s, clip.frames, None, (clip.name,) * len(clip))


def take_from_bag(folder: Path) -> Take:
    """Show what a recording holds.

    Raises:
        InputFileError: when it cannot be read or has no states.
    """
    states = read_recording(folder, ("state",)).states
    if not states:
        raise InputFileError(f"{folder}: holds no states of an executor; there is nothing to show")
    times_ns = np.array([state.time_ns for state in states])
    return Take(
        times_s=(times_ns - times_ns[0]) / NS_PER_S,
        avatar=stack([state.actual for state in states]),
        target=stack([state.target for state in states]),
        captions=tuple(Mode(state.mode).name.lower() for state in states),
    )


def load_take(path: Path) -> Take:
    """Read a clip (a file) or a bag (a folder).

    Raises:
        InputFileError: when it is neither.
    """
    if is_library(path):
        raise InputFileError(
            f"{path}: is a clip library; draw a clip of it: `unicon motions render CLIP --library {path}`"
        )
    if path.is_dir():
        return take_from_bag(path)
    if path.suffix == ".npz":
        return take_from_clip(load_clip(path))
    raise InputFileError(f"{path}: is neither the folder of a recording nor a clip (*.npz)")
