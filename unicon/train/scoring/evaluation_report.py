"""Shows an evaluation: a table for the terminal, CSV, JSON and a picture."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.table import Table

from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.store.library_index import replace_file
from unicon.observation import OBSERVATION_ID
from unicon.reward import RewardTerms
from unicon.train.scoring.evaluation import MEANS, SHARES, Evaluation, Group, summarise
from unicon.train.scoring.tracking_metrics import S1_DISTANCE_M, S3_HEIGHT_M, S3_TILT

FORMAT = "unicon-evaluation-1"
DIGITS = 6
PROTOCOL = {
    "run": "every clip once from its first frame, MuJoCo, 60 Hz control, 240 Hz physics, deterministic",
    "survival": "share of the clip before any reward term falls under 0.1; mean over clips",
    "success": f"mean distance of the 20 bodies never over {S1_DISTANCE_M} m (PHC); share of clips",
    "success_s3": f"heights of root, ankles and wrists never off by over {S3_HEIGHT_M} m, up axis in the "
    f"root's frame by over {S3_TILT} (SONIC, BeyondMimic); share of clips",
    "reward": "sum of the rewards until a term falls under 0.1, over the ticks of the clip; mean over clips",
    "errors": "means over the frames before the S1 failure of a clip, of all clips together",
    "chatter": "share of the torques' power above 10 Hz",
    "skate_mm_per_frame": "horizontal way of a foot's point of contact while the foot carries weight",
}
"""What the figures mean; it goes into every file."""


class Column(NamedTuple):
    """A column of the table in the terminal."""

    name: str
    heading: str
    form: str


COLUMNS = (
    Column("survival", "survival", "{:.3f}"),
    Column("success", "S1", "{:.1%}"),
    Column("success_s3", "S3", "{:.1%}"),
    Column("reward", "reward", "{:.3f}"),
    Column("global_mm", "global mm", "{:.0f}"),
    Column("root_relative_mm", "relative mm", "{:.0f}"),
    Column("velocity_m_s", "vel m/s", "{:.2f}"),
    Column("acceleration_m_s2", "acc m/s²", "{:.1f}"),
    Column("chatter", "chatter", "{:.3f}"),
    Column("skate_mm_per_frame", "skate mm", "{:.1f}"),
)


def columns_of(*names: str) -> tuple[Column, ...]:
    """Return the columns of these figures, in this order."""
    by_name = {column.name: column for column in COLUMNS}
    return tuple(by_name[name] for name in names)


TERM_COLUMNS = tuple(Column(name, name.replace("_", " "), "{:.3f}") for name in RewardTerms._fields)


def tables(evaluation: Evaluation) -> tuple[Table, Table]:
    """Return the figures by class, and the reward's five terms by class."""
    groups = summarise(evaluation)
    title = f"{evaluation.policy}: {evaluation.clips}"
    return _table(title, groups, COLUMNS), _table("terms of the reward", groups, TERM_COLUMNS)


def _table(title: str, groups: Sequence[Group], columns: Sequence[Column]) -> Table:
    table = Table(title=title)
    table.add_column("class")
    for heading in ("clips", *(column.heading for column in columns)):
        table.add_column(heading, justify="right")
    for group in groups:
        depth = group.path.count("/") + 1 if group.path else 0
        name = "  " * depth + (group.path.rsplit("/", 1)[-1] or "all")
        figures = [_show(column.form, group.figures[column.name]) for column in columns]
        table.add_row(name, str(group.clips), *figures, style="bold" if not group.path else "")
    return table


def _show(form: str, value: float) -> str:
    return form.format(value) if math.isfinite(value) else "-"


def as_json(evaluation: Evaluation) -> dict[str, Any]:
    """Return all of it for a file: nothing in it depends on when or where it was made."""
    groups = summarise(evaluation)
    return {
        "format": FORMAT,
        "policy": evaluation.policy,
        "clips": evaluation.clips,
        "frames_file": evaluation.frames_file,
        "humanoid_id": HUMANOID.id,
        "observation_id": OBSERVATION_ID,
        "protocol": PROTOCOL,
        "all": _group_as_json(groups[0]),
        "classes": {group.path: _group_as_json(group) for group in groups[1:]},
        "runs": [
            {"clip": info.name, "class": info.label, **_rounded(score._asdict())}
            for info, score in zip(evaluation.infos, evaluation.scores, strict=True)
        ],
    }


def _group_as_json(group: Group) -> dict[str, Any]:
    return {"clips": group.clips, "ticks": group.ticks, **_rounded(group.figures)}


def _rounded(values: dict[str, Any]) -> dict[str, Any]:
    """Return figures with six digits after the point; what was not measured is null."""
    return {
        name: (round(value, DIGITS) if math.isfinite(value) else None) if isinstance(value, float) else value
        for name, value in values.items()
    }


def write_json(path: Path, values: dict[str, Any]) -> None:
    """Write a file in one step.

    Raises:
        UniconError: when it cannot be written.
    """
    _write(path, json.dumps(values, indent=1, ensure_ascii=False) + "\n")


def write_csv(path: Path, evaluation: Evaluation) -> None:
    """Write a row for all clips, one a class and one a clip.

    Raises:
        UniconError: when it cannot be written.
    """
    names = (*SHARES, *MEANS)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["kind", "name", "clips", "ticks", *names])
    for group in summarise(evaluation):
        figures = _rounded(group.figures)
        kind, name = ("class", group.path) if group.path else ("all", "all")
        writer.writerow([kind, name, group.clips, group.ticks, *(figures[n] for n in names)])
    for info, score in zip(evaluation.infos, evaluation.scores, strict=True):
        figures = _rounded(score._asdict())
        writer.writerow(["clip", info.name, 1, score.ticks, *(figures[n] for n in names)])
    _write(path, text.getvalue())


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, text)
    except OSError as error:
        raise UniconError(f"{path}: cannot be written ({error.strerror}); choose another place") from error


def draw(evaluation: Evaluation, path: Path) -> None:
    """Draw scores by class, how long each clip was followed, and how well.

    Raises:
        UniconError: when the picture cannot be written.
    """
    groups = [group for group in summarise(evaluation) if "/" not in group.path]
    figure = Figure(figsize=(13, 4 + 0.25 * len(groups)), layout="constrained")
    by_class, terms, over_time, errors = figure.subplots(2, 2).flat
    names = ("survival", "success", "success_s3")
    _draw_bars(by_class, groups, names, ("survival", "success S1", "success S3"))
    _draw_bars(terms, groups, RewardTerms._fields, [n.replace("_", " ") for n in RewardTerms._fields])
    _draw_survival(over_time, evaluation)
    _draw_errors(errors, evaluation)
    figure.suptitle(f"{evaluation.policy}: {evaluation.clips}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=120)
    except (OSError, ValueError) as error:
        raise UniconError(f"{path}: cannot be drawn ({error}); expected a name such as scores.png") from error


def _draw_bars(axes: Axes, groups: Sequence[Group], names: Sequence[str], labels: Sequence[str]) -> None:
    places, height = np.arange(len(groups)), 0.8 / len(names)
    for index, (name, label) in enumerate(zip(names, labels, strict=True)):
        values = np.nan_to_num([group.figures[name] for group in groups])
        axes.barh(places + (index - 0.5 * (len(names) - 1)) * height, values, height, label=label)
    axes.set_yticks(places, [f"{group.path or 'all'} ({group.clips})" for group in groups])
    axes.invert_yaxis()
    axes.set_xlim(0.0, 1.0)
    axes.legend(fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(names))


def _draw_survival(axes: Axes, evaluation: Evaluation) -> None:
    """Draw which share of the clips was followed for at least which share of its length."""
    shares = np.sort([score.survival for score in evaluation.scores])
    left = 1.0 - np.arange(len(shares) + 1) / len(shares)
    axes.step([*shares, 1.0], left, where="pre")
    axes.set(xlabel="share of the clip", ylabel="clips that survive so far", xlim=(0, 1), ylim=(0, 1.02))
    axes.grid(alpha=0.3)


def _draw_errors(axes: Axes, evaluation: Evaluation) -> None:
    values = [
        [s.root_relative_mm for s in evaluation.scores if s.success == success and s.scored_ticks]
        for success in (1.0, 0.0)
    ]
    labels = ["to the end (S1)", "lost"]
    axes.hist(values, bins=30, stacked=True, label=labels, color=["#0072B2", "#D55E00"])
    axes.set(xlabel="error relative to the root [mm], frames before the S1 failure", ylabel="clips")
    axes.legend(fontsize=7)
