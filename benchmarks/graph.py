"""`make bench-graph`: the graph for 60 s with executor, stitching and recorder, measured from its recording.

At the same time and on the same machine a bare loop sleeps until sixty deadlines a second: its lateness is
what the machine itself costs. Writes out/bench/graph.json.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro
from rich.console import Console

from unicon.recording.session_report import Spread, report_on, spread, to_table
from unicon_bringup.graph import GraphConfig
from unicon_bringup.session import GraphSession

MOTIONS = ("walk", "turn_left", "jump", "wave", "punch", "run", "dance")
SLEEP_LOOP = Path(__file__).parent / "sleep_loop.py"
START_S = 4.0
"""What is left out at the beginning: the start of the processes themselves."""


@dataclass(frozen=True)
class BenchConfig:
    """How long to measure, and where to write."""

    seconds: float = 60.0
    out: Path = Path("out/bench/graph.json")


def resident_mb(name: str) -> float:
    """Return the memory of the newest process whose command line holds ``name`` [MB]."""
    pids = subprocess.run(["pgrep", "-f", name], capture_output=True, text=True, check=False).stdout.split()
    sizes = [0.0]
    for pid in pids:
        status = Path(f"/proc/{pid}/status")
        lines = status.read_text().splitlines() if status.exists() else []
        sizes += [float(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS")]
    return max(sizes)


def measure(config: BenchConfig, folder: Path) -> dict[str, object]:
    """Run the graph and return the figures."""
    bag = folder / "session"
    graph = GraphConfig(avatar="bench", record=True, output=str(bag))
    with GraphSession(graph, folder / "graph.log") as session:
        session.wait_until_ready()
        session.wait_until_recorded("state", "target_frames of stitching")
        session.spin_for(1.0)
        session.reset()
        for motion in MOTIONS * 3:
            session.queue(motion, 0.5)
        sleeper = subprocess.Popen(
            [sys.executable, str(SLEEP_LOOP), str(config.seconds)], stdout=subprocess.PIPE, text=True
        )
        session.spin_for(config.seconds + START_S)
        rss_mb = resident_mb("executor_node")
        late_ms = 1e3 * np.array(json.loads(sleeper.communicate()[0]))
    report = report_on(bag, skip_s=START_S)
    Console().print(to_table(report))
    return {
        "seconds": report.seconds,
        "rate_hz": report.rate_hz,
        "missed_percent": report.missed_percent,
        "tick_ms": report.tick_ms._asdict(),
        "jitter_ms": report.jitter_ms._asdict(),
        "sleep_jitter_ms": Spread(*spread(late_ms))._asdict(),
        "target_age_ms": report.target_age_ms._asdict(),
        "rss_mb": rss_mb,
        "lost_messages": report.lost_messages,
    }


def main() -> None:
    """Measure and write the figures."""
    config = tyro.cli(BenchConfig, prog="make bench-graph", description=__doc__)
    with tempfile.TemporaryDirectory() as folder:
        figures = measure(config, Path(folder))
    config.out.parent.mkdir(parents=True, exist_ok=True)
    config.out.write_text(json.dumps(figures, indent=2) + "\n")
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
