"""Looks whether this machine has what an avatar takes, and says what to type where something lacks.

Run by ``unicon doctor``, or ``python -m unicon.doctor``.
"""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from unicon import machine_probes as probes

Status = Literal["ok", "warning", "failure"]
ROOT = Path(__file__).resolve().parents[1]
APT = "sudo apt install"
COLOURS = {"ok": "green", "warning": "yellow", "failure": "bold red"}


@dataclass(frozen=True)
class Finding:
    """What one look at the machine told."""

    name: str
    status: Status
    value: str
    """What was found."""
    advice: str = ""
    """What to do about it; empty where all is well."""


@dataclass(frozen=True)
class DoctorConfig:
    """What counts as enough."""

    pace_s: float = 3.0
    """How long the 60 Hz loop is watched [s]."""
    physics_ticks: int = 120
    """How many ticks of the humanoid's physics are timed."""
    free_disk_gb: float = 2.0
    """Below it a recording or an update may not fit [GB]."""
    free_memory_gb: float = 1.0
    """Below it the graph and the renderer may not fit [GB]."""


def examine(config: DoctorConfig = DoctorConfig()) -> list[Finding]:  # noqa: B008 - frozen
    """Look at everything, which takes some ten seconds."""
    return list(_examine(config))


def _examine(config: DoctorConfig) -> Iterator[Finding]:
    looks: tuple[Callable[[], Finding], ...] = (
        examine_python,
        examine_compiler,
        examine_cores,
        lambda: examine_memory(config),
        lambda: examine_disk(config),
        examine_gl,
        examine_discovery,
        lambda: examine_pace(config),
        lambda: examine_physics(config),
    )
    for look in looks:
        yield look()


def examine_python(version: tuple[int, int] = sys.version_info[:2]) -> Finding:
    """Look whether this Python is one that the packages exist for."""
    value = f"{version[0]}.{version[1]}"
    if (3, 11) <= version <= (3, 13):
        return Finding("Python", "ok", value)
    advice = "use 3.11, 3.12 or 3.13: make PYTHON=python3.12 setup"
    return Finding("Python", "failure", value, advice)


def examine_compiler() -> Finding:
    """Look for what builds the ROS messages; the library alone does without."""
    compiler = shutil.which("c++") or shutil.which("g++")
    header = Path(sysconfig.get_paths()["include"], "Python.h")
    if compiler and header.exists():
        return Finding("C++ compiler", "ok", f"{compiler}, with Python's headers")
    missing = "no Python.h" if compiler else "no c++ or g++"
    advice = f"building ROS messages needs it: {APT} g++ python3-dev"
    return Finding("C++ compiler", "warning", missing, advice)


def examine_cores() -> Finding:
    """Count the cores that this process may use."""
    cores = len(os.sched_getaffinity(0))
    if cores >= 2:
        return Finding("cores", "ok", str(cores))
    advice = "the graph wants two; start it with slow_motion:=true"
    return Finding("cores", "warning", str(cores), advice)


def examine_memory(config: DoctorConfig) -> Finding:
    """Look how much memory is free."""
    free_gb = probes.free_memory_bytes() / 1e9
    value = f"{free_gb:.1f} GB free"
    if free_gb >= config.free_memory_gb:
        return Finding("memory", "ok", value)
    advice = f"close other programs: {config.free_memory_gb:g} GB should be free"
    return Finding("memory", "warning", value, advice)


def examine_disk(config: DoctorConfig) -> Finding:
    """Look how much room is left where recordings go."""
    free_gb = shutil.disk_usage(Path.cwd()).free / 1e9
    value = f"{free_gb:.1f} GB free"
    if free_gb >= config.free_disk_gb:
        return Finding("disk", "ok", value)
    status: Status = "warning" if free_gb >= config.free_disk_gb / 10 else "failure"
    return Finding("disk", status, value, f"make room: {config.free_disk_gb:g} GB should be free")


def examine_gl() -> Finding:
    """Draw a small picture with each OpenGL that MuJoCo can use off screen."""
    backend = probes.drawing_backend()
    if backend:
        return Finding("OpenGL", "ok", f"draws with {backend}")
    advice = f"for pictures and video: {APT} libegl1 libgl1-mesa-dri"
    return Finding("OpenGL", "warning", "neither EGL nor OSMesa draws", advice)


def examine_discovery() -> Finding:
    """Let two processes find each other: over ROS where it is installed, else over plain UDP."""
    name = "discovery on loopback"
    if probes.has_ros() and (ROOT / probes.DISCOVERY_SCRIPT).exists():
        found_s = probes.discovery_seconds(ROOT / probes.DISCOVERY_SCRIPT)
        if found_s is not None:
            return Finding(name, "ok", f"two ROS nodes met in {found_s:.2f} s")
        advice = "let UDP on lo through the firewall, and unset RMW_IMPLEMENTATION"
        return Finding(name, "failure", "two ROS nodes did not find each other in 10 s", advice)
    if probes.hears_itself_over_udp():
        return Finding(name, "ok", "UDP works; ROS is not installed, so it was not tried")
    return Finding(name, "failure", "no UDP on 127.0.0.1", "let UDP on lo through the firewall")


def examine_pace(config: DoctorConfig) -> Finding:
    """Look how late a sleep loop at 60 Hz wakes up, which no program here can better."""
    late = probes.sleep_lateness(config.pace_s)
    p50, p99, worst = (1e3 * seconds for seconds in late)
    value = f"late by p50 {p50:.1f}, p99 {p99:.1f}, max {worst:.1f} ms"
    if late.p99 < 0.5 / probes.RATE_HZ:
        return Finding("60 Hz loop", "ok", value)
    advice = "the machine is busy: close other programs, or start the graph with slow_motion:=true"
    return Finding("60 Hz loop", "warning", value, advice)


def examine_physics(config: DoctorConfig) -> Finding:
    """Look how much faster than needed the humanoid's physics runs."""
    steps_per_s = probes.physics_steps_per_s(config.physics_ticks)
    factor = steps_per_s / probes.PHYSICS_HZ
    value = f"{steps_per_s:,.0f} steps/s, {factor:.0f} times real time"
    if factor >= 4.0:
        return Finding("physics", "ok", value)
    status: Status = "warning" if factor >= 1.0 else "failure"
    return Finding("physics", status, value, "start the graph with slow_motion:=true")


def exit_status(findings: list[Finding]) -> int:
    """Return 0 unless something is missing without which nothing works."""
    return int(any(finding.status == "failure" for finding in findings))


def as_table(findings: list[Finding]) -> Table:
    """Return the findings for a terminal."""
    table = Table("", "", "found", "what to do")
    for f in findings:
        colour = COLOURS[f.status]
        table.add_row(f.name, f"[{colour}]{f.status}[/]", escape(f.value), escape(f.advice))
    return table


def main(console: Console | None = None) -> int:
    """Examine this machine and print what was found; return the exit status."""
    console = console or Console()
    with console.status("looking at this machine, about ten seconds ..."):
        findings = examine()
    console.print(as_table(findings))
    return exit_status(findings)


if __name__ == "__main__":
    sys.exit(main())
