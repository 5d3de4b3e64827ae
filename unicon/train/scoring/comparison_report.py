"""Shows a comparison: one table for the terminal, as JSON, CSV and Markdown, and the learning curves."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib.figure import Figure
from rich.table import Table

from unicon.errors import UniconError
from unicon.motion.store.library_index import replace_file
from unicon.train.runs.metrics_log import METRICS_FILE
from unicon.train.scoring.evaluation_report import columns_of, write_json

FORMAT = "unicon-comparison-1"
NAME = "comparison"
"""Of the files, before .json, .csv, .md and .png."""


class CurvePoint(NamedTuple):
    """A policy while it learns."""

    minutes: float
    """Of training [core min]."""
    survival: float
    """Mean over some clips of the training, in MuJoCo."""
    success: float
    """The same."""


@dataclass(frozen=True)
class Outcome:
    """What a candidate came to."""

    name: str
    minutes: float
    """Of training [core min]."""
    million_samples: float
    train: dict[str, float] | None
    """Figures by the names of ``ClipScores``; None where there was nothing to score."""
    test: dict[str, float] | None
    """None, too, where its policy cannot follow clips that it has not learned."""
    curve: tuple[CurvePoint, ...]

    @property
    def samples_per_s(self) -> float:
        """Speed of the training, of one core."""
        return 1e6 * self.million_samples / (60.0 * self.minutes) if self.minutes else math.nan

    def as_json(self) -> dict[str, Any]:
        """Return it as plain values; what is no number is null."""
        return {**asdict(self), "train": _finite(self.train), "test": _finite(self.test)}

    @staticmethod
    def from_json(values: dict[str, Any]) -> Outcome:
        """Read what ``as_json`` gave."""
        curve = tuple(CurvePoint(*point) for point in values["curve"])
        sides = {side: _with_nan(values[side]) for side in ("train", "test")}
        return Outcome(**{**values, **sides, "curve": curve})


COLUMNS = columns_of("survival", "success", "success_s3", "reward", "root_relative_mm", "chatter")
"""Columns with both sides of the split."""


def read_curve(folder: Path) -> tuple[CurvePoint, ...]:
    """Return the evaluations of a run by the time of training, out of its log."""
    seconds: dict[int, float] = {}
    points: dict[int, CurvePoint] = {}
    for line in (folder / METRICS_FILE).read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        iteration = row["iteration"]
        if "time/seconds" in row:
            seconds[iteration] = row["time/seconds"]
        if "evaluation/survival" in row:
            scores = row["evaluation/survival"], row["evaluation/success"]
            points[iteration] = CurvePoint(seconds[iteration] / 60.0, *scores)
    return tuple(points.values())


def table(outcomes: Sequence[Outcome], dataset: str) -> Table:
    """Return the figures side by side, for the terminal."""
    shown = Table(title=f"{dataset}: scores in MuJoCo, train / test")
    headings, *rows = _rows(outcomes)
    for index, heading in enumerate(headings):
        shown.add_column(heading, justify="right" if index else "left", no_wrap=not index)
    for row in rows:
        shown.add_row(*row)
    return shown


def write_report(out: Path, outcomes: Sequence[Outcome], dataset: str, minutes: float) -> None:
    """Write comparison.json, .csv, .md and .png.

    Raises:
        UniconError: when they cannot be written.
    """
    runs = [{**outcome.as_json(), "samples_per_s": outcome.samples_per_s} for outcome in outcomes]
    head = {"format": FORMAT, "dataset": dataset, "minutes": minutes}
    write_json(out / f"{NAME}.json", {**head, "runs": runs})
    _write(out / f"{NAME}.csv", _as_csv(outcomes))
    _write(out / f"{NAME}.md", _as_markdown(outcomes))
    _draw(outcomes, f"{dataset}, {minutes:g} core min each", out / f"{NAME}.png")


def _rows(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, ...]]:
    """Yield the headings, then a row of texts for each; scores are those of train / test."""
    yield ("run", "core min", "M samples", "samples/s", *(column.heading for column in COLUMNS))
    for outcome in outcomes:
        speed = f"{outcome.minutes:.1f}", f"{outcome.million_samples:.2f}", f"{outcome.samples_per_s:.0f}"
        sides = outcome.train, outcome.test
        scores = [
            " / ".join(_show(column.form, side[column.name]) if side else "-" for side in sides)
            for column in COLUMNS
        ]
        yield (outcome.name, *speed, *scores)


def _show(form: str, value: float) -> str:
    return form.format(value) if math.isfinite(value) else "-"


def _as_markdown(outcomes: Sequence[Outcome]) -> str:
    headings, *rows = _rows(outcomes)
    rule = ["---", *["---:"] * (len(headings) - 1)]
    return "".join(f"| {' | '.join(row)} |\n" for row in (headings, rule, *rows))


def _as_csv(outcomes: Sequence[Outcome]) -> str:
    """Return all figures, with all their digits, a row a run."""
    names = sorted(
        {name for outcome in outcomes for side in (outcome.train, outcome.test) for name in side or ()}
    )
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        [
            "run",
            "minutes",
            "million_samples",
            *(f"{side}_{name}" for side in ("train", "test") for name in names),
        ]
    )
    for outcome in outcomes:
        sides = (_finite(outcome.train) or {}, _finite(outcome.test) or {})
        figures = [side.get(name) for side in sides for name in names]
        writer.writerow([outcome.name, outcome.minutes, outcome.million_samples, *figures])
    return text.getvalue()


def _draw(outcomes: Sequence[Outcome], title: str, path: Path) -> None:
    figure = Figure(figsize=(12, 5), layout="constrained")
    for axes, name in zip(figure.subplots(1, 2), ("survival", "success"), strict=True):
        for outcome in outcomes:
            values = [getattr(point, name) for point in outcome.curve]
            axes.plot([point.minutes for point in outcome.curve], values, marker=".", label=outcome.name)
        axes.set(
            xlabel="training [core min]",
            ylabel=f"{name} of clips of the training",
            ylim=(0, 1.02),
            xlim=(0, None),
        )
        axes.grid(alpha=0.3)
    figure.axes[0].legend(fontsize=8)
    figure.suptitle(title)
    try:
        figure.savefig(path, dpi=120)
    except OSError as error:
        raise UniconError(f"{path}: cannot be drawn ({error.strerror})") from error


def _write(path: Path, text: str) -> None:
    try:
        replace_file(path, text)
    except OSError as error:
        raise UniconError(f"{path}: cannot be written ({error.strerror}); choose another place") from error


def _finite(figures: dict[str, float] | None) -> dict[str, float | None] | None:
    if figures is None:
        return None
    return {name: value if math.isfinite(value) else None for name, value in figures.items()}


def _with_nan(figures: dict[str, float | None] | None) -> dict[str, float] | None:
    if figures is None:
        return None
    return {name: math.nan if value is None else value for name, value in figures.items()}
