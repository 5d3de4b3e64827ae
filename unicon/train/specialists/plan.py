"""The state of a training by specialists on disk: ``plan.json``, which stages are done and how they went.

A stage is a folder with a run in it. Each is written down when it is done, in one step; what is not in the
plan is gone on with from its newest checkpoint. ``clusters.yaml`` lies beside it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from unicon.errors import InputFileError
from unicon.train.runs.settings import build, plain
from unicon.train.runs.state_file import write_in_one_step
from unicon.train.specialists.clusters import Cluster, clusters_of, read_clusters, write_clusters

PLAN_FILE = "plan.json"


@dataclass(frozen=True)
class ClipResult:
    """How a stage's policy follows a clip from noisy starts."""

    name: str
    survival: float
    """Mean share of a run before a term is below its threshold, 0 to 1."""
    success: float
    """Share of the runs that succeeded, 0 to 1."""

    @property
    def mastered(self) -> bool:
        """Whether all runs survived and succeeded."""
        return self.survival == 1.0 and self.success == 1.0


@dataclass(frozen=True)
class StageResult:
    """A stage that is done."""

    seconds: float
    """Spent training [s]."""
    clips: tuple[ClipResult, ...] = ()
    """What was measured, for stages whose clips are."""

    def by_clip(self) -> Mapping[str, ClipResult]:
        """Return the clips by name."""
        return {clip.name: clip for clip in self.clips}


@dataclass(frozen=True)
class _Entry:
    stage: str
    result: StageResult


@dataclass(frozen=True)
class _File:
    rounds: tuple[float, ...] = ()
    done: tuple[_Entry, ...] = ()
    format: int = 1


@dataclass
class Plan:
    """Rounds, clusters, and the stages that are done."""

    folder: Path
    rounds: list[float] = field(default_factory=list)
    """Budget of each round that was begun [min]."""
    clusters: list[Cluster] = field(default_factory=list)
    done: dict[str, StageResult] = field(default_factory=dict)
    """Stages, each by its folder's place in this one."""

    def begin_round(self, minutes: float, clusters: list[Cluster]) -> None:
        """Begin a round with new clusters."""
        self.add_clusters(clusters)
        self.rounds.append(minutes)
        self._save()

    def add_clusters(self, clusters: list[Cluster]) -> None:
        """Write down more clusters; those that are there already stay as they are."""
        known = {cluster.name for cluster in self.clusters}
        self.clusters += [cluster for cluster in clusters if cluster.name not in known]
        write_clusters(self.folder, self.clusters)

    def finish(self, stage: str, result: StageResult) -> None:
        """Write down that a stage is done."""
        self.done[stage] = result
        self._save()

    def of_round(self, number: int, single: bool) -> list[Cluster]:
        """Return the clusters of a round: those of classes, or those of single clips."""
        return [c for c in self.clusters if c.round == number and c.single == single]

    def teachers(self, until_round: int) -> dict[str, tuple[Cluster, ClipResult]]:
        """Return for each clip the specialist that follows it best, of those that are done.

        The latest of equals is taken: it had more time.
        """
        best: dict[str, tuple[Cluster, ClipResult]] = {}
        ready = [c for c in self.clusters if c.round <= until_round and c.stage in self.done]
        for clip, clusters in clusters_of(ready).items():
            rated = [(cluster, self.done[cluster.stage].by_clip()[clip]) for cluster in clusters]
            best[clip] = max(reversed(rated), key=lambda pair: (pair[1].success, pair[1].survival))
        return best

    @property
    def last_run(self) -> Path | None:
        """Folder of the run that the newest finished student is in; None where there is none yet."""
        for number in range(len(self.rounds), 0, -1):
            for stage in (numbered("finetuned", number), numbered("student", number)):
                if stage in self.done:
                    return self.folder / stage
        return None

    def _save(self) -> None:
        entries = tuple(_Entry(stage, result) for stage, result in self.done.items())
        content = json.dumps(plain(_File(tuple(self.rounds), entries)), indent=1)
        write_in_one_step(self.folder / PLAN_FILE, f"{content}\n")


def read_plan(folder: Path) -> Plan:
    """Return the plan of a folder, empty where there is none yet.

    Raises:
        InputFileError: when a file says something else than it should.
    """
    path = folder / PLAN_FILE
    try:
        values = json.loads(path.read_text()) if path.is_file() else {}
    except (OSError, ValueError) as error:
        raise InputFileError(f"{path}: cannot be read as a plan ({error})") from error
    content = build(_File, values, str(path))
    done = {entry.stage: entry.result for entry in content.done}
    clusters = read_clusters(folder)
    # a round that was not begun in full is begun again
    clusters = [cluster for cluster in clusters if cluster.round <= len(content.rounds)]
    return Plan(folder, list(content.rounds), clusters, done)


def numbered(stage: str, number: int) -> str:
    """Return the name of a stage in a round."""
    return stage if number == 1 else f"{stage}-{number}"
