"""`unicon`: the commands of the library. Each imports what it needs when it is called."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from unicon.errors import UniconError
from unicon.render.show import RenderConfig


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
        from dataclasses import replace

        from unicon.render.show import render
        from unicon.render.take import load_take

        config = self.config
        if config.video is None and config.contact_sheet is None:
            name = self.path.resolve().stem
            folder = Path("out/render")
            config = replace(config, video=folder / f"{name}.mp4", contact_sheet=folder / f"{name}.png")
        render(load_take(self.path), config, console)
        for written in (config.video, config.contact_sheet):
            if written is not None:
                console.print(str(written))
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
class MotionsFetch:
    """Fetch free motions into the cache."""

    def run(self, console: Console) -> int:
        """Fetch them and print where they are."""
        from unicon.motion.fetch import fetch

        console.print(str(fetch(console).folder))
        return 0


@dataclass(frozen=True)
class MotionsList:
    """List the fetched motions."""

    def run(self, console: Console) -> int:
        """Print a table of them."""
        from rich.table import Table

        from unicon.motion.fetch import fetch

        library = fetch(console)
        table = Table("motion", "seconds", "class", "source", "licence")
        for name in library.names:
            clip = library.get(name)
            table.add_row(name, f"{clip.duration_s:.1f}", clip.label, clip.source, clip.licence)
        console.print(table)
        return 0


Bag = (
    Annotated[BagInfo, tyro.conf.subcommand("info")]
    | Annotated[BagRepair, tyro.conf.subcommand("repair")]
    | Annotated[BagReplay, tyro.conf.subcommand("replay")]
)
Motions = (
    Annotated[MotionsFetch, tyro.conf.subcommand("fetch")]
    | Annotated[MotionsList, tyro.conf.subcommand("list")]
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
    """Motions: fetch, list."""

    command: Annotated[Motions, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Run the command."""
        return self.command.run(console)


Command = (
    Annotated[Doctor, tyro.conf.subcommand("doctor")]
    | Annotated[Render, tyro.conf.subcommand("render")]
    | Annotated[BagCommand, tyro.conf.subcommand("bag")]
    | Annotated[MotionsCommand, tyro.conf.subcommand("motions")]
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
