"""Where the clips of an evaluation come from: a library, or any folder or archive of motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Literal

import numpy as np
from rich.console import Console

from unicon import rotations
from unicon.errors import UniconError
from unicon.motion.clip import Clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.formats.motion_file import MotionFile, find_motion_files
from unicon.motion.importing.file_processing import ImportTask, process_file
from unicon.motion.importing.processed_file import ProcessedFile
from unicon.motion.importing.worker_pool import Died, run_all
from unicon.motion.store.library import ClipLibrary, as_states
from unicon.state import CharacterState
from unicon.train.environment.dataset import DatasetConfig, choose_clips

Split = Literal["train", "test", "all"]


@dataclass(frozen=True)
class ClipSource:
    """Some clips: those of a library, which are read where they are needed, or clips themselves."""

    title: str
    """What they are, in words."""
    infos: tuple[ClipInfo, ...]
    library: Path | None = None
    clips: tuple[Clip, ...] = ()
    """One an info, where there is no library."""
    frames_file: str = ""
    """Name of the library's file of frames, which has the hash of its content."""

    def part(self, indices: Sequence[int]) -> ClipSource:
        """Return some of them."""
        clips = tuple(self.clips[i] for i in indices) if self.clips else ()
        return replace(self, infos=tuple(self.infos[i] for i in indices), clips=clips)

    def load(self) -> list[Clip]:
        """Return the clips."""
        if self.library is None:
            return list(self.clips)
        library = _open(self.library)
        return [library.get(info.name) for info in self.infos]


@lru_cache(maxsize=2)
def _open(folder: Path) -> ClipLibrary:
    return ClipLibrary(folder)


def from_library(library: ClipLibrary, dataset: str = "All", split: Split = "all") -> ClipSource:
    """Return the clips of a library that can be followed: no marks, half a second or longer.

    Raises:
        UniconError: when there is no such sub-dataset, or no clip is left.
    """
    chosen = choose_clips(library, DatasetConfig(dataset, "both" if split == "all" else split))
    title = f"{dataset} of {library.folder.name}, split {split}"
    return ClipSource(title, tuple(chosen.infos), library.folder, frames_file=library.frames_file)


def from_clips(clips: Sequence[Clip], title: str = "clips") -> ClipSource:
    """Return clips that are in memory."""
    infos = [
        ClipInfo(clip.name, len(clip), clip.label or "other", "", clip.source, clip.licence) for clip in clips
    ]
    return ClipSource(title, tuple(infos), None, tuple(clips))


def from_path(path: Path, jobs: int, console: Console) -> ClipSource:
    """Read, clean and retarget the motions of a file, a folder or a zip archive, as an import does.

    What is refused is said on the console.

    Raises:
        UniconError: when the path does not exist, or none of its files can be used.
    """
    files = sorted(find_motion_files([path]), key=lambda file: file.origin)
    done = dict(run_all(_read, files, jobs))
    infos, clips = [], []
    for file in files:
        result = done[file]
        refused = result.reason if isinstance(result, Died) else result.refused
        if refused or isinstance(result, Died):
            console.print(f"left out: {refused}", soft_wrap=True, highlight=False, markup=False)
            continue
        for clip in result.clips:
            infos.append(clip.info)
            clips.append(_to_clip(clip.info, clip.rows))
    if not clips:
        raise UniconError(
            f"{path}: holds no motion that can be used; expected clips (*.npz), BVH, AMC or such"
        )
    return ClipSource(path.name, tuple(_with_own_names(infos)), None, tuple(clips))


def _read(file: MotionFile) -> ProcessedFile:
    try:
        return process_file(ImportTask(file))
    except UniconError as error:
        return ProcessedFile(refused=str(error))


def _to_clip(info: ClipInfo, rows: np.ndarray) -> Clip:
    """Return the clip that a library would have of these rows."""
    frames = {name: np.array(value, np.float64) for name, value in vars(as_states(rows)).items()}
    frames["root_quat_w"] = rotations.normalize(frames["root_quat_w"])
    return Clip(info.name, CharacterState(**frames), info.source, info.licence, info.label)


def _with_own_names(infos: Sequence[ClipInfo]) -> list[ClipInfo]:
    """Return rows of which no two have the same name: the later ones get a number."""
    counts: dict[str, int] = {}
    named = []
    for info in infos:
        counts[info.name] = counts.get(info.name, 0) + 1
        number = counts[info.name]
        named.append(info if number == 1 else replace(info, name=f"{info.name}#{number}"))
    return named
