"""Curves of a network's training out of its log."""

from __future__ import annotations

import json
from pathlib import Path

from matplotlib.figure import Figure

from unicon.errors import UniconError
from unicon.schedulers.pfnn.layout import OUTPUT_LAYOUT
from unicon.train.runs.metrics_log import METRICS_FILE

PLOT_FILE = "training.png"
_CURVES = (
    ("loss/training", "while learning, with dropout and noise"),
    ("loss/learned", "learned takes"),
    ("loss/held_out", "held-out takes"),
)


def draw_training(folder: Path, path: Path) -> None:
    """Draw the losses and the error of each part of the output over the time of training.

    Args:
        folder: of the run, with its log.
        path: picture to write.

    Raises:
        UniconError: when the log cannot be read or the picture not be written.
    """
    try:
        lines = (folder / METRICS_FILE).read_text(encoding="utf-8").splitlines()
        rows = [json.loads(line) for line in lines]
        figure = _draw(rows)
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=100)
    except (OSError, ValueError, KeyError) as error:
        raise UniconError(f"{path}: the training cannot be drawn ({error})") from error


def _draw(rows: list[dict[str, float]]) -> Figure:
    figure = Figure(figsize=(12, 5), layout="constrained")
    losses, parts = figure.subplots(1, 2)
    for name, label in _CURVES:
        points = [(row["time/seconds"] / 60.0, row[name]) for row in rows if name in row]
        losses.plot(*zip(*points, strict=True) if points else ((), ()), marker=".", label=label)
    losses.set(xlabel="training [min]", ylabel="loss (1: answering the mean)", yscale="log")
    minutes = [row["time/seconds"] / 60.0 for row in rows]
    for name, _ in OUTPUT_LAYOUT:
        parts.plot(minutes, [row[f"share/{name}"] for row in rows], marker=".", label=name)
    parts.set(
        xlabel="training [min]", ylabel="held-out error of each part, share of its variance", yscale="log"
    )
    for axes in (losses, parts):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    return figure
