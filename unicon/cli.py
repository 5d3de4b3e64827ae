"""`unicon`: the commands of the library. Each imports what it needs when it is called."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro
from rich.console import Console

from unicon.errors import UniconError
from unicon.motion.motion_commands import MotionsImport, MotionsList, MotionsSplit, MotionsStats, MotionsTree
from unicon.render.show import RenderConfig
from unicon.tool_commands import FetchCmu, MotionsExport, MotionsInspect, find_clip
from unicon.train.comparison_commands import Compare
from unicon.train.evaluation_commands import Evaluate, Robustness
from unicon.train.pfnn_commands import PfnnConvert, PfnnTrain
from unicon.train.train_commands import Average, Export, Train

if TYPE_CHECKING:
    from unicon.render.take import Take


@dataclass(frozen=True)
class Doctor:
    """Look whether this machine has what it takes."""

    def run(self, console: Console) -> int:
        """Examine the machine."""
        from unicon.doctor import main

        return main(console)


@dataclass(frozen=True)
class Render:
    """Draw a clip (*.npz) or a recording (a bag's folder) as a video and a contact sheet."""

    path: Annotated[Path, tyro.conf.Positional]
    """Clip or bag."""
    config: Annotated[RenderConfig, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Draw what was asked for; a video and a contact sheet beside each other where nothing was."""
        from unicon.render.take import load_take

        return draw(load_take(self.path), self.config, self.path.resolve().stem, console)


def draw(take: Take, config: RenderConfig, name: str, console: Console) -> int:
    """Draw a take, into out/render where no file is given, and print what was written."""
    from unicon.render.show import render

    if config.video is None and config.contact_sheet is None:
        folder = Path("out/render")
        config = replace(config, video=folder / f"{name}.mp4", contact_sheet=folder / f"{name}.png")
    render(take, config, console)
    for written in (config.video, config.contact_sheet):
        if written is not None:
            console.print(str(written), soft_wrap=True)
    return 0


@dataclass(frozen=True)
class BagInfo:
    """Show what a recording holds."""

    bag: Annotated[Path, tyro.conf.Positional]

    def run(self, console: Console) -> int:
        """Print the topics and the session's figures."""
        from unicon.recording.bag_commands import show_info

        return show_info(self.bag, console)


@dataclass(frozen=True)
class BagRepair:
    """Mend a recording whose recorder was killed."""

    bag: Annotated[Path, tyro.conf.Positional]

    def run(self, console: Console) -> int:
        """Mend it in its place."""
        from unicon.recording.bag_commands import repair

        return repair(self.bag, console)


@dataclass(frozen=True)
class BagReplay:
    """Simulate a recording again and compare every state to the bit."""

    bag: Annotated[Path, tyro.conf.Positional]

    def run(self, console: Console) -> int:
        """Print "bit-exact" and the number of ticks, or the first difference."""
        from unicon.recording.bag_commands import replay

        return replay(self.bag, console)


@dataclass(frozen=True)
class FetchFree:
    """Fetch the free motions that a package registry holds (DeepMimic's) into the cache."""

    def run(self, console: Console) -> int:
        """Fetch them and print where they are."""
        from unicon.motion.fetching.fetch import fetch

        console.print(str(fetch(console).folder), soft_wrap=True)
        return 0


Fetch = Annotated[FetchFree, tyro.conf.subcommand("free")] | Annotated[FetchCmu, tyro.conf.subcommand("cmu")]


@dataclass(frozen=True)
class MotionsFetch:
    """Fetch motions: the free ones of a package registry where nothing else is named."""

    command: Annotated[Fetch, tyro.conf.arg(name="")] = field(default_factory=FetchFree)

    def run(self, console: Console) -> int:
        """Run the command."""
        return self.command.run(console)


@dataclass(frozen=True)
class MotionsRender:
    """Draw a clip of a library as a video and a contact sheet."""

    clip: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="CLIP")]
    """Its name in the library, or its file (*.npz)."""
    config: Annotated[RenderConfig, tyro.conf.arg(name="")]
    library: Path | None = None
    """Library that the name is of; $UNICON_LIBRARY or else the shipped one where it is not given."""

    def run(self, console: Console) -> int:
        """Draw what was asked for; a video and a contact sheet beside each other where nothing was."""
        from unicon.render.take import take_from_clip

        clip, _ = find_clip(self.clip, self.library, console)
        return draw(take_from_clip(clip), self.config, clip.name, console)


Bag = (
    Annotated[BagInfo, tyro.conf.subcommand("info")]
    | Annotated[BagRepair, tyro.conf.subcommand("repair")]
    | Annotated[BagReplay, tyro.conf.subcommand("replay")]
)
Motions = (
    Annotated[MotionsFetch, tyro.conf.subcommand("fetch")]
    | Annotated[MotionsImport, tyro.conf.subcommand("import")]
    | Annotated[MotionsList, tyro.conf.subcommand("list")]
    | Annotated[MotionsStats, tyro.conf.subcommand("stats")]
    | Annotated[MotionsTree, tyro.conf.subcommand("tree")]
    | Annotated[MotionsSplit, tyro.conf.subcommand("split")]
    | Annotated[MotionsInspect, tyro.conf.subcommand("inspect")]
    | Annotated[MotionsRender, tyro.conf.subcommand("render")]
    | Annotated[MotionsExport, tyro.conf.subcommand("export")]
)


@dataclass(frozen=True)
class BagCommand:
    """Recordings: info, repair, replay."""

    command: Annotated[Bag, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Run the command."""
        return self.command.run(console)


@dataclass(frozen=True)
class MotionsCommand:
    """Motions: fetch, import, list, stats, tree, split, inspect, render, export."""

    command: Annotated[Motions, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Run the command."""
        return self.command.run(console)


Pfnn = (
    Annotated[PfnnTrain, tyro.conf.subcommand("train")]
    | Annotated[PfnnConvert, tyro.conf.subcommand("convert")]
)


@dataclass(frozen=True)
class PfnnCommand:
    """The network of the keyboard scheduler: train, convert."""

    command: Annotated[Pfnn, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Run the command."""
        return self.command.run(console)


Command = (
    Annotated[Doctor, tyro.conf.subcommand("doctor")]
    | Annotated[Render, tyro.conf.subcommand("render")]
    | Annotated[BagCommand, tyro.conf.subcommand("bag")]
    | Annotated[MotionsCommand, tyro.conf.subcommand("motions")]
    | Annotated[Train, tyro.conf.subcommand("train")]
    | Annotated[Average, tyro.conf.subcommand("average")]
    | Annotated[Export, tyro.conf.subcommand("export")]
    | Annotated[PfnnCommand, tyro.conf.subcommand("pfnn")]
    | Annotated[Evaluate, tyro.conf.subcommand("evaluate")]
    | Annotated[Robustness, tyro.conf.subcommand("robustness")]
    | Annotated[Compare, tyro.conf.subcommand("compare")]
)


def main() -> int:
    """Run the command that the words ask for; return the exit status."""
    command = tyro.cli(Command, prog="unicon", description=__doc__)  # type: ignore[arg-type]
    console = Console()
    try:
        return command.run(console)
    except UniconError as error:
        print(f"unicon: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
