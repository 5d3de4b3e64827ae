"""The report of an import: what became of each file. The next import reads it to skip what is unchanged."""

from __future__ import annotations

import json
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from unicon.motion.clip_index import RATE_HZ, ClipInfo
from unicon.motion.store.library_index import replace_file

REPORT_FILE = "import_report.json"
READABLE_FILE = "import_report.md"
REPORT_VERSION = 1
_KIND = re.compile(r"(\w+) .*?\((\w+)\)")
"""What a decision did and for which reason, e.g. cut frames 0-12 (idle_end): ..."""


@dataclass(frozen=True)
class FileRecord:
    """What became of one source file."""

    origin: str
    """The file, e.g. archive.zip/folder/take.bvh."""
    content: str
    """Hash of what it holds."""
    key: str
    """Hash of all that its clips depend on; empty where the next import has to try again."""
    family: str = ""
    """Skeleton family."""
    clips: tuple[str, ...] = ()
    """Names of its clips in the library, without mirrored copies."""
    decisions: tuple[str, ...] = ()
    """What cleaning did, and why."""
    refused: str = ""
    """Why it has no clips."""
    duplicate_of: str = ""
    """The file that holds the same bytes, where there is one: its clips are not added twice."""
    source: str = ""
    """Where it comes from, as the file or a person says; empty where only its name tells."""
    licence: str = ""
    """As the file or a person says."""
    label: str = ""
    """Its class or what it shows, as the file says."""
    seconds: float = 0.0
    """Time of one core that it took."""
    frames: int = 0
    """Frames at 60 Hz that came out."""


@dataclass(frozen=True)
class ImportRun:
    """One call of the command that changed something."""

    seconds: float
    """Wall-clock time, with that of work that was taken over from an interrupted run."""
    jobs: int
    made: int
    """Files that were read and turned into clips, or refused."""
    unchanged: int
    """Files that were skipped."""


@dataclass(frozen=True)
class ImportReport:
    """All files that a library was made of."""

    files: tuple[FileRecord, ...] = ()
    runs: tuple[ImportRun, ...] = ()
    """Since the library was last made from nothing."""

    @property
    def refused(self) -> list[FileRecord]:
        """The files without clips."""
        return [record for record in self.files if record.refused]

    @property
    def seconds(self) -> float:
        """Wall-clock time of all runs."""
        return sum(run.seconds for run in self.runs)

    @property
    def frames_per_second_per_core(self) -> float:
        """How fast a core makes frames, from reading to measuring."""
        made = [record for record in self.files if not record.refused]
        return sum(r.frames for r in made) / max(sum(r.seconds for r in made), 1e-9)


def read_report(folder: Path) -> ImportReport:
    """Return a library's report; an empty one where there is none that can be used."""
    try:
        content = json.loads((folder / REPORT_FILE).read_text(encoding="utf-8"))
        if content["version"] != REPORT_VERSION:
            return ImportReport()
        runs = tuple(ImportRun(**run) for run in content["runs"])
        return ImportReport(tuple(_to_record(row) for row in content["files"]), runs)
    except (OSError, ValueError, KeyError, TypeError):
        return ImportReport()


def _to_record(row: dict[str, Any]) -> FileRecord:
    return FileRecord(**{**row, "clips": tuple(row["clips"]), "decisions": tuple(row["decisions"])})


def write_report(folder: Path, report: ImportReport, infos: Sequence[ClipInfo]) -> None:
    """Write the report for programs and for people.

    Raises:
        OSError: when it cannot be written.
    """
    content = {"version": REPORT_VERSION, **asdict(report)}
    replace_file(folder / REPORT_FILE, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
    replace_file(folder / READABLE_FILE, to_markdown(report, infos))


def to_markdown(report: ImportReport, infos: Sequence[ClipInfo]) -> str:
    """Return the report for people: totals, quality by family and class, what was refused and changed."""
    families = {name: record.family for record in report.files for name in record.clips}
    own = [info for info in infos if info.name in families]
    lines = ["# Import", "", _totals(report, infos), ""]
    for title, key in (
        ("family", lambda info: families[info.name]),
        ("class", lambda info: info.label.split("/")[0]),
    ):
        lines += [f"## Quality by {title}", "", *_quality_table(own, title, key), ""]
    lines += ["## Files without clips", "", *_refused(report), ""]
    lines += ["## Decisions of cleaning", "", *_decisions(report), ""]
    return "\n".join(lines)


def _totals(report: ImportReport, infos: Sequence[ClipInfo]) -> str:
    frames = sum(info.frames for info in infos)
    return (
        f"{len(infos)} clips with {frames} frames ({frames / RATE_HZ / 60:.1f} minutes) out of "
        f"{len(report.files)} files, {len(report.refused)} of them refused. It took {report.seconds:.0f} s; "
        f"a core makes {report.frames_per_second_per_core:.0f} frames/s."
    )


def _quality_table(infos: Sequence[ClipInfo], title: str, key: Callable[[ClipInfo], str]) -> list[str]:
    groups: dict[str, list[ClipInfo]] = defaultdict(list)
    for info in infos:
        groups[key(info)].append(info)
    figures = list(dict.fromkeys(name for info in infos for name in info.quality))
    lines = [
        "Means over frames; of worst and max the largest.",
        "",
        "| " + " | ".join([title, "clips", "seconds", *figures]) + " |",
        "|---" * (3 + len(figures)) + "|",
    ]
    for name, group in [*sorted(groups.items()), ("all", list(infos))]:
        joined = join_quality(group)
        seconds = sum(info.seconds for info in group)
        cells = [name or "?", str(len(group)), f"{seconds:.0f}"]
        cells += [f"{joined[figure]:.2f}" if figure in joined else "" for figure in figures]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def join_quality(infos: Sequence[ClipInfo]) -> Mapping[str, float]:
    """Return each figure over clips: the largest of worst and maximum, the mean over frames of all others."""
    values: dict[str, list[tuple[float, int]]] = defaultdict(list)
    for info in infos:
        for name, value in info.quality.items():
            if np.isfinite(value):
                values[name].append((value, info.frames))
    joined = {}
    for name, pairs in values.items():
        figures, frames = zip(*pairs, strict=True)
        largest = name.startswith(("worst_", "max_"))
        joined[name] = float(max(figures) if largest else np.average(figures, weights=frames))
    return joined


def _refused(report: ImportReport) -> list[str]:
    """Return why files have no clips; most reasons begin with the file's name already."""
    lines = [f"- {r.origin}: {r.refused.removeprefix(f'{r.origin}: ')}" for r in report.refused]
    lines += [f"- {r.origin}: holds the same as {r.duplicate_of}" for r in report.files if r.duplicate_of]
    return lines or ["None."]


def _decisions(report: ImportReport) -> list[str]:
    """Return how often cleaning decided what for which reason, then each decision."""
    texts = [(record.origin, text) for record in report.files for text in record.decisions]
    kinds = Counter(match.groups() for _, text in texts if (match := _KIND.match(text)))
    lines = [f"- {count} x {what} for {reason}" for (what, reason), count in kinds.most_common()]
    lines += ["", *(f"- {origin}: {text}" for origin, text in texts)] if texts else ["None."]
    return lines
