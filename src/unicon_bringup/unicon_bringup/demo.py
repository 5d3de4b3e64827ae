"""`make demo`: half a minute of a live avatar, recorded, drawn and measured.

Real motion capture goes through the real graph: the stitching node plays clips, the executor follows, the
recorder records.
"""

from __future__ import annotations

import json
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import tyro
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from unicon.errors import UniconError
from unicon.motion.store.library_choice import open_library
from unicon.recording.session_report import report_on, to_table
from unicon.render.gl import NoGLError
from unicon.render.scene import Picture
from unicon.render.show import RenderConfig, render
from unicon.render.take import take_from_bag
from unicon_bringup.graph import GraphConfig
from unicon_bringup.session import GraphSession

SETTLE_S = 0.5
SHEET_PICTURE = Picture(480, 360)


@dataclass(frozen=True)
class DemoConfig:
    """What the demo plays, and where it leaves its results."""

    motions: tuple[str, ...] = ("stand", "walk", "stand", "wave", "jump", "walk", "stand")
    """Motions to play, one after the other."""
    seconds: float = 32.0
    """How long the avatar lives."""
    transition_s: float = 0.4
    """Length of the transition into each motion [s]."""
    avatar: str = "demo"
    """Namespace of the avatar."""
    out: Path = Path("out/demo")
    """Folder for the results; an earlier demo's are replaced."""


def main() -> int:
    """Run the demo; return the exit status."""
    config = tyro.cli(DemoConfig, prog="make demo", description=__doc__)
    console = Console()
    try:
        run_demo(config, console)
        return 0
    except UniconError as error:
        console.print(f"[red]demo:[/red] {error}")
        return 2
    except KeyboardInterrupt:
        return 130


def run_demo(config: DemoConfig, console: Console) -> None:
    """Play, record, draw and measure.

    Raises:
        UniconError: when a motion is not there or the graph does not come up.
    """
    bag = config.out / "session"
    shutil.rmtree(config.out, ignore_errors=True)
    config.out.mkdir(parents=True)
    library = open_library(None, console)
    licences = sorted({library.info(motion).licence for motion in config.motions})
    console.print(f"motions: {library.folder} (licences: {', '.join(licences)})")
    play(config, bag, console)
    report = report_on(bag)
    (config.out / "report.json").write_text(json.dumps(report.to_dict(), indent=2) + "\n")
    pictures = draw(config, bag, console)
    console.print(to_table(report))
    if not report.policy_trained:
        console.print(
            f"The policy is {report.policy}: untrained position servos, which know nothing of balance. "
            "The avatar falls and is put back into its target."
        )
    for label, path in (("bag", bag), *pictures, ("report", config.out / "report.json")):
        console.print(f"{label:>14}: {path}")


def play(config: DemoConfig, bag: Path, console: Console) -> None:
    """Run the graph with the motions queued."""
    graph = GraphConfig(avatar=config.avatar, record=True, output=str(bag.absolute()))
    with GraphSession(graph, config.out / "graph.log") as session:
        session.wait_until_ready()
        session.wait_until_recorded("state", "target_frames of stitching")
        session.spin_for(SETTLE_S)
        session.reset()
        for motion in config.motions:
            session.queue(motion, config.transition_s)
        columns = (TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn())
        with Progress(*columns, console=console, transient=True) as progress:
            task = progress.add_task("living", total=config.seconds)
            session.spin_for(config.seconds, lambda elapsed: progress.update(task, completed=elapsed))


def draw(config: DemoConfig, bag: Path, console: Console) -> list[tuple[str, Path]]:
    """Draw the video and the contact sheet, where this machine can; return where they are."""
    take = take_from_bag(bag)
    video, sheet = config.out / "demo.mp4", config.out / "contact.png"
    try:
        render(take, RenderConfig(contact_sheet=sheet, picture=SHEET_PICTURE), console)
        render(take, RenderConfig(video=video), console)
    except NoGLError as error:
        console.print(f"no pictures: {error}")
        return []
    return [("video", video), ("contact sheet", sheet)]


if __name__ == "__main__":
    sys.exit(main())
