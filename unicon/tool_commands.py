"""`unicon motions export|inspect|fetch cmu`: each imports what it needs when it is called."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro
from rich.console import Console

if TYPE_CHECKING:
    from unicon.motion.clip import Clip
    from unicon.motion.clip_index import ClipInfo
    from unicon.state import CharacterState


@dataclass(frozen=True)
class MotionsExport:
    """Write a clip, or what a recorded avatar did, as BVH for Blender, Maya and other tools."""

    motion: Annotated[str, tyro.conf.Positional]
    """A clip's name in the library, a clip's file (*.npz), or the folder of a recording."""
    out: Path | None = None
    """BVH file to write; in the present folder, with the motion's name, where it is not given."""
    library: Path | None = None
    """Library that the name is of; $UNICON_LIBRARY or else the shipped one where it is not given."""
    target: bool = False
    """Of a recording, write what the avatar was to do instead of what it did."""
    unit: Literal["cm", "m"] = "cm"
    """Unit of length of the file."""

    def run(self, console: Console) -> int:
        """Write the file and print where it is."""
        from unicon.motion.formats.bvh_export import write_bvh

        frames = self._frames(console)
        out = self.out or Path(f"{Path(self.motion).resolve().stem}.bvh")
        write_bvh(frames, out, self.unit)
        console.print(str(out), soft_wrap=True)
        return 0

    def _frames(self, console: Console) -> CharacterState:
        from unicon.errors import UniconError
        from unicon.motion.formats.bvh_export import at_60_hz
        from unicon.render.take import take_from_bag

        if Path(self.motion).is_dir():
            take = take_from_bag(Path(self.motion))
            frames = take.target if self.target and take.target is not None else take.avatar
            return at_60_hz(take.times_s, frames)
        if self.target:
            raise UniconError(f"{self.motion}: is not the folder of a recording; only those have a target")
        return find_clip(self.motion, self.library, console)[0].frames


@dataclass(frozen=True)
class MotionsInspect:
    """Show how good a clip is: figures, and plots of its path, feet, speed and hinges."""

    clip: Annotated[str, tyro.conf.Positional]
    """Its name in the library, or its file (*.npz)."""
    library: Path | None = None
    """Library that the name is of; $UNICON_LIBRARY or else the shipped one where it is not given."""
    plots: Path | None = None
    """PNG to write; out/inspect/CLIP.png where it is not given."""

    def run(self, console: Console) -> int:
        """Print the figures and write the plots."""
        from unicon.motion.inspection import inspect, plot, show

        clip, info = find_clip(self.clip, self.library, console)
        inspection = inspect(clip, info)
        show(inspection, console)
        plots = self.plots or Path("out/inspect") / f"{Path(clip.name).name}.png"
        plot(inspection, plots)
        console.print(str(plots), soft_wrap=True)
        return 0


@dataclass(frozen=True)
class FetchCmu:
    """Fetch the CMU motion capture database from its own site (needs the internet)."""

    subjects: tuple[int, ...] = ()
    """Numbers of the subjects; all where none is given: some 2400 files, several gigabytes."""
    out: Path | None = None
    """Folder for the files; one in the user's cache where it is not given."""
    base_url: str = ""
    """Address of a copy of the site; the site itself where it is not given."""

    def run(self, console: Console) -> int:
        """Fetch what is not there yet and print what was done."""
        from unicon.motion.fetching.cmu_database import BASE_URL, CmuConfig, fetch_cmu

        done = fetch_cmu(CmuConfig(self.subjects, self.out, self.base_url or BASE_URL), console)
        console.print(f"{done.folder}: {done.new} files fetched, {done.kept} were there", soft_wrap=True)
        if done.missing:
            shown = ", ".join(Path(name).name for name in done.missing[:10])
            console.print(f"the server does not have {len(done.missing)} takes that its index names: {shown}")
        console.print(f"make clips of them with `unicon motions import {done.folder}`", soft_wrap=True)
        return 0


def find_clip(name: str, library: Path | None, console: Console) -> tuple[Clip, ClipInfo | None]:
    """Return a clip by its file or by its name in a library, there with its row of the index.

    Raises:
        InputFileError: when the file or the library cannot be read.
        UnknownNameError: when the library has no such clip.
    """
    from unicon.motion.clip import load_clip
    from unicon.motion.store.library_choice import open_library

    if name.endswith(".npz"):
        return load_clip(Path(name)), None
    clips = open_library(library, console)
    return clips.get(name), clips.info(name)
