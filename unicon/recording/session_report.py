"""What a recorded session was like: rates, times, errors and how long the avatar stayed on its feet."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.table import Table

from unicon import rotations
from unicon.errors import InputFileError
from unicon.humanoid.kinematics import forward_kinematics
from unicon.recording.bag_reading import RecordedState, Recording, read_recording
from unicon.simulation import CONTROL_HZ
from unicon.state import CharacterState, stack
from unicon.target_frames import NS_PER_S
from unicon.tracking import TrackerConfig


class Spread(NamedTuple):
    """Median, 99th percentile and maximum."""

    p50: float
    p99: float
    max: float


@dataclass(frozen=True)
class SessionReport:
    """The figures of one session."""

    policy: str
    policy_trained: bool
    seconds: float
    ticks: int
    rate_hz: float
    missed_ticks: int
    missed_percent: float
    tick_ms: Spread
    jitter_ms: Spread
    target_age_ms: Spread
    joint_error_mean_mm: float
    """Mean over ticks and joints of the joints' distance to the target's, both relative to the root."""
    joint_error_worst_mm: float
    """The largest of a tick's mean over the joints."""
    upright_seconds: float
    """Time in which the pelvis was not lower than the target's by more than a fall."""
    falls: int
    resets: int
    lost_messages: int

    def to_dict(self) -> dict[str, object]:
        """Return the figures for a JSON file."""
        spreads = {name: value._asdict() for name, value in vars(self).items() if isinstance(value, Spread)}
        return {**asdict(self), **spreads}


def report_on(folder: Path, skip_s: float = 0.0) -> SessionReport:
    """Return the report on a bag, without its first ``skip_s`` seconds.

    Raises:
        InputFileError: when it cannot be read, or holds no states or status.
    """
    recording = read_recording(folder, ("state", "target_frames", "status"))
    states, statuses = recording.states, recording.statuses
    if states and skip_s:
        first = states[0].tick + round(skip_s * CONTROL_HZ)
        states = [state for state in states if state.tick >= first]
        statuses = [status for status in statuses if status.ticks >= first]
    if len(states) < 2 or not statuses:
        raise InputFileError(f"{folder}: holds too few states or no status for a report")
    actual, target = stack([s.actual for s in states]), stack([s.target for s in states])
    errors_mm = 1e3 * joint_errors_m(actual, target)
    status = statuses[-1]
    seconds = (states[-1].time_ns - states[0].time_ns) / NS_PER_S
    missed = int(status.missed_ticks) - int(statuses[0].missed_ticks)
    ages_ms = np.array([1e3 * s.target_age_s for s in states if s.target_age_s >= 0.0])
    return SessionReport(
        policy=status.policy,
        policy_trained=bool(status.policy_trained),
        seconds=seconds,
        ticks=len(states),
        rate_hz=(states[-1].tick - states[0].tick) / seconds,
        missed_ticks=missed,
        missed_percent=100.0 * missed / len(states),
        tick_ms=_milliseconds(status.tick_time_p50, status.tick_time_p99, status.tick_time_max),
        jitter_ms=_milliseconds(status.jitter_p50, status.jitter_p99, status.jitter_max),
        target_age_ms=spread(ages_ms) if len(ages_ms) else Spread(0.0, 0.0, 0.0),
        joint_error_mean_mm=float(errors_mm.mean()),
        joint_error_worst_mm=float(errors_mm.max()),
        upright_seconds=float(np.sum(_is_upright(actual, target))) / CONTROL_HZ,
        falls=int(status.falls),
        resets=states[-1].episode - states[0].episode,
        lost_messages=_lost(states) + _lost_targets(recording),
    )


def joint_errors_m(actual: CharacterState, target: CharacterState) -> np.ndarray:
    """Return the mean distance ``(T,)`` [m] of the 19 joints, each relative to its root and heading."""

    def positions_h(states: CharacterState) -> np.ndarray:
        offset_w = forward_kinematics(states).pos_w[:, 1:] - states.root_pos_w[:, None]
        return rotations.rotate_inverse(rotations.heading(states.root_quat_w)[:, None], offset_w)

    return np.linalg.norm(positions_h(actual) - positions_h(target), axis=-1).mean(axis=-1)


def spread(values: np.ndarray) -> Spread:
    """Return median, 99th percentile and maximum."""
    p50, p99 = np.percentile(values, [50, 99])
    return Spread(float(p50), float(p99), float(values.max()))


def to_table(report: SessionReport) -> Table:
    """Return the report as a table."""
    trained = "" if report.policy_trained else " (untrained)"
    rows = (
        ("policy", report.policy + trained),
        ("rate", f"{report.rate_hz:.2f} Hz over {report.seconds:.1f} s"),
        ("missed ticks", f"{report.missed_ticks} ({report.missed_percent:.2f} %)"),
        ("tick time", _show(report.tick_ms)),
        ("deadline jitter", _show(report.jitter_ms)),
        ("target age", _show(report.target_age_ms)),
        (
            "joint error",
            f"mean {report.joint_error_mean_mm:.0f} mm, worst {report.joint_error_worst_mm:.0f} mm",
        ),
        ("upright", f"{report.upright_seconds:.1f} of {report.seconds:.1f} s"),
        ("falls, resets", f"{report.falls}, {report.resets}"),
        ("lost messages", str(report.lost_messages)),
    )
    table = Table("", "", show_header=False)
    for row in rows:
        table.add_row(*row)
    return table


def _show(values: Spread) -> str:
    return f"p50 {values.p50:.2f}, p99 {values.p99:.2f}, max {values.max:.2f} ms"


def _milliseconds(*seconds: float) -> Spread:
    return Spread(*(1e3 * float(value) for value in seconds))


def _is_upright(actual: CharacterState, target: CharacterState) -> np.ndarray:
    return actual.root_pos_w[:, 2] > target.root_pos_w[:, 2] - TrackerConfig().fall_height_m


def _lost(states: list[RecordedState]) -> int:
    return states[-1].tick - states[0].tick + 1 - len(states)


def _lost_targets(recording: Recording) -> int:
    numbers: dict[str, list[int]] = {}
    for message in recording.targets:
        numbers.setdefault(message.source, []).append(message.sequence)
    steps = [np.diff(np.array(sequences)) for sequences in numbers.values()]
    return int(sum((step[step > 1] - 1).sum() for step in steps))
