"""What there is in training data, by manoeuvre: how much, how fast it goes, and how far its feet slide."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip import continuous_signs
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles
from unicon.schedulers.pfnn.layout import GAITS, PRESENT, unpack_input, unpack_output
from unicon.state import differentiate
from unicon.train.pfnn.training_data import TrainingData
from unicon.train.runs.state_file import write_in_one_step

REPORT_FILE = "data.md"
MADE = {"reversed": "reversed", "aside": "aside", "on the spot": "on the spot", "strides": "short strides"}
"""Words in a take's name, and what they say that was done to it; the first that fits counts."""
_RANGE = (5.0, 95.0)


class ReportRow(NamedTuple):
    """All takes of a kind that were made in the same way."""

    title: str
    """E.g. backward, reversed."""
    takes: int
    minutes: float
    gaits: tuple[float, ...]
    """Share of each gait of ``GAITS``, at the present."""
    forward_m_s: tuple[float, float]
    """5th and 95th percentile."""
    left_m_s: tuple[float, float]
    turn_deg_s: tuple[float, float]
    slide_cm_s: tuple[float, float]
    """Of heels and balls in contact along the ground: mean and 99th percentile."""


def report_of(data: TrainingData) -> list[ReportRow]:
    """Return a row for each kind of manoeuvre and way of making it."""
    groups: dict[str, list[int]] = defaultdict(list)
    for take, (name, kind) in enumerate(zip(data.names, data.kinds, strict=True)):
        groups[title_of(name, kind)].append(take)
    return [_row(title, takes, data) for title, takes in sorted(groups.items())]


def title_of(name: str, kind: str) -> str:
    """Return what a take shows and what was done to it, e.g. ``walking, bent``."""
    words = [made for word, made in MADE.items() if f" {word} " in f"{name} "][:1]
    if " bent " in name and " bent +0 " not in f"{name} ":
        words.append("bent")
    return ", ".join([kind, *words])


def slides(outputs: np.ndarray) -> np.ndarray:
    """Return how fast points in contact go along the ground ``(K,)`` [m/s], of one take's ``(T, O)``."""
    parts = unpack_output(outputs.astype(np.float64))
    turned = np.cumsum(parts["turn_rate"][:, 0]) / RATE_HZ
    before = rotations.from_heading(np.concatenate([[0.0], turned[:-1]]))
    velocity_h = np.pad(parts["root_vel_h"], ((0, 0), (0, 1)))
    pos_w = np.cumsum(rotations.rotate(before, velocity_h), axis=0) / RATE_HZ
    pos_w[:, 2] = parts["root_height"][:, 0]
    x, y = np.split(parts["root_rot6d_h"], 2, axis=-1)
    tilt = rotations.from_matrix(np.stack([x, y, np.cross(x, y)], axis=-1))
    quat_w = continuous_signs(rotations.multiply(rotations.from_heading(turned), tilt))
    points_w = Soles(forward_kinematics(differentiate(pos_w, quat_w, parts["joint_pos"], RATE_HZ))).points_w
    speeds = np.linalg.norm(np.diff(points_w[..., :2], axis=0), axis=-1).reshape(len(pos_w) - 1, 4) * RATE_HZ
    contact = parts["contacts"] > 0.5
    return speeds[contact[1:] & contact[:-1]]


def write_report(folder: Path, data: TrainingData) -> None:
    """Write the rows of all data into a folder.

    Raises:
        UniconError: when it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_in_one_step(folder / REPORT_FILE, as_markdown(report_of(data)))


def as_markdown(rows: list[ReportRow]) -> str:
    """Return the rows as a page with a table."""
    return "\n".join(_lines(rows)) + "\n"


def _row(title: str, takes: list[int], data: TrainingData) -> ReportRow:
    rows = np.isin(data.sequences, takes)
    outputs = data.outputs[rows]
    parts = unpack_output(outputs)
    gaits = unpack_input(data.inputs[rows])["path_gait"][:, PRESENT].mean(axis=0, dtype=float)
    slid = np.concatenate([slides(data.outputs[data.sequences == take]) for take in takes])
    forward, left = parts["root_vel_h"].T
    return ReportRow(
        title,
        len(takes),
        int(rows.sum()) / RATE_HZ / 60.0,
        tuple(gaits.tolist()),
        _range(forward),
        _range(left),
        _range(np.degrees(parts["turn_rate"])),
        (100.0 * float(slid.mean()), 100.0 * float(np.percentile(slid, 99))) if len(slid) else (0.0, 0.0),
    )


def _range(values: np.ndarray) -> tuple[float, float]:
    low, high = np.percentile(values, _RANGE).tolist()
    return low, high


def _lines(rows: list[ReportRow]) -> Iterator[str]:
    gaits = " / ".join(GAITS)
    yield from ("# What the network learned from", "")
    yield from ("Mirrored takes and those that it is judged by included; ranges hold 90 % of the frames.", "")
    yield f"| manoeuvre | takes | min | {gaits} [%] | forward, left [m/s] | turn [deg/s] | slide [cm/s] |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        shares = " / ".join(f"{100 * share:.0f}" for share in row.gaits)
        speeds = ", ".join(f"{low:.2f} to {high:.2f}" for low, high in (row.forward_m_s, row.left_m_s))
        turn = f"{row.turn_deg_s[0]:.0f} to {row.turn_deg_s[1]:.0f}"
        slide = f"{row.slide_cm_s[0]:.1f}, p99 {row.slide_cm_s[1]:.0f}"
        yield f"| {row.title} | {row.takes} | {row.minutes:.1f} | {shares} | {speeds} | {turn} | {slide} |"
