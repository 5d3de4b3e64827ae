"""`unicon bag`: info, repair and replay, for a person at a terminal."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.table import Table

from unicon.recording.bag_reading import TYPES, open_bag
from unicon.recording.bag_repair import repair_bag
from unicon.recording.replay import replay_bag
from unicon.recording.session_report import report_on, to_table


def show_info(folder: Path, console: Console) -> int:
    """Print the topics of a bag, and the report where an executor was recorded."""
    with open_bag(folder) as bag:
        seconds = (bag.duration or 0) / 1e9
        console.print(f"{folder}: {bag.message_count} messages in {seconds:.1f} s")
        table = Table("topic", "type", "messages")
        for topic, info in sorted(bag.topics.items()):
            table.add_row(topic, str(info.msgtype), str(info.msgcount))
        kinds = {TYPES.get(str(info.msgtype)) for info in bag.topics.values()}
    console.print(table)
    if {"state", "status"} <= kinds:
        console.print(to_table(report_on(folder)))
    return 0


def repair(folder: Path, console: Console) -> int:
    """Mend a bag and say what was found."""
    repaired = repair_bag(folder)
    console.print(
        f"{folder}: kept {repaired.messages} messages over {repaired.seconds:.1f} s; "
        f"the damaged file is {repaired.kept}"
    )
    return 0


def replay(folder: Path, console: Console) -> int:
    """Simulate a bag again; return 1 when it differs."""
    with console.status("simulating again ..."):
        result = replay_bag(folder)
    if result.skipped:
        console.print(f"begins at tick {result.first_tick}, a reset; {result.skipped} ticks lie before it")
    if result.difference is None:
        console.print(f"bit-exact: {result.ticks} ticks")
        return 0
    d = result.difference
    console.print(f"differs at tick {d.tick}: {d.field}{d.recorded} recorded, {d.replayed} simulated again")
    return 1
