"""Evaluates a policy: every clip once from its first frame, in as many processes as there are cores.

The answer is the same, to the bit, whatever the number of processes: a clip's run depends on the clip alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil
from typing import NamedTuple

import numpy as np

from unicon.errors import UniconError
from unicon.motion.catalogue.class_tree import class_tree
from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing.worker_pool import Died, core_count, run_all
from unicon.policy import Policy
from unicon.train.scoring.evaluation_clips import ClipSource
from unicon.train.scoring.evaluation_runs import Perturbation, run_clips
from unicon.train.scoring.tracking_metrics import ClipScores

BATCH_CLIPS = 16
"""So many clips run together at most; more hardly make the policy's inputs cheaper."""

SHARES = ("survival", "success", "success_s3", "reward")
"""Figures that are averaged over clips, of whatever length."""
MEANS = tuple(
    name for name in ClipScores._fields if name not in (*SHARES, "ticks", "scored_ticks", "first_broken")
)
"""Figures that are averaged over frames: clips weigh by how many of theirs were scored."""

UNPERTURBED = Perturbation()


@dataclass(frozen=True)
class Batch:
    """Clips that one process runs together."""

    policy: Policy
    indices: tuple[int, ...]
    source: ClipSource
    perturbation: Perturbation


class Evaluation(NamedTuple):
    """All clips with their figures, in the order of the source."""

    policy: str
    clips: str
    """What they are, in words."""
    infos: tuple[ClipInfo, ...]
    scores: tuple[ClipScores, ...]
    frames_file: str = ""
    """Name of the library's file of frames, which has the hash of its content; empty without a library."""


class Group(NamedTuple):
    """The figures of a class of clips."""

    path: str
    """Its place in the class tree; empty for all clips."""
    clips: int
    ticks: int
    figures: dict[str, float]
    """By the names of `ClipScores`."""


def evaluate(
    policy: Policy,
    source: ClipSource,
    perturbation: Perturbation = UNPERTURBED,
    jobs: int = 0,
    on_done: Callable[[int], None] = lambda clips: None,
) -> Evaluation:
    """Run a policy over clips.

    Args:
        policy: what moves the avatars; it has to be picklable where there are several processes.
        source: the clips.
        perturbation: what is made harder.
        jobs: processes; 0: one a core, 1: all in this process.
        on_done: is told, now and then, how many more clips are done.

    Raises:
        UniconError: when a process was killed.
    """
    jobs = jobs or core_count()
    scores: dict[int, ClipScores] = {}
    for batch, result in run_all(_run_batch, _batches(policy, source, perturbation, jobs), jobs):
        if isinstance(result, Died):
            raise UniconError(f"evaluation: {result.reason}; try again with fewer --jobs")
        scores.update(zip(batch.indices, result, strict=True))
        on_done(len(result))
    in_order = tuple(scores[index] for index in range(len(scores)))
    return Evaluation(policy.name, source.title, source.infos, in_order, source.frames_file)


def summarise(evaluation: Evaluation) -> list[Group]:
    """Return the figures of all clips, then of each class and those below it, in the tree's order."""
    tree = class_tree(evaluation.infos)
    return [_group(node.path, [evaluation.scores[row] for row in node.rows()]) for node in tree.root.walk()]


def _group(path: str, scores: Sequence[ClipScores]) -> Group:
    figures = {name: float(np.mean([getattr(score, name) for score in scores])) for name in SHARES}
    weights = np.array([score.scored_ticks for score in scores], dtype=float)
    for name in MEANS:
        figures[name] = _weighted_mean(np.array([getattr(score, name) for score in scores]), weights)
    return Group(path, len(scores), sum(score.ticks for score in scores), figures)


def _weighted_mean(values: np.ndarray, weights: np.ndarray) -> float:
    """Return the mean of the values that were measured, not a number for none."""
    known = np.isfinite(values) & (weights > 0)
    return float(np.average(values[known], weights=weights[known])) if known.any() else float("nan")


def _batches(policy: Policy, source: ClipSource, perturbation: Perturbation, jobs: int) -> list[Batch]:
    """Return clips of like lengths together, the longest first, so that all cores end at the same time."""
    order = sorted(range(len(source.infos)), key=lambda i: (-source.infos[i].frames, i))
    size = min(BATCH_CLIPS, ceil(len(order) / (2 * jobs))) if order else 1
    parts = [tuple(order[first : first + size]) for first in range(0, len(order), size)]
    return [Batch(policy, part, source.part(part), perturbation) for part in parts]


def _run_batch(batch: Batch) -> list[ClipScores]:
    return [run.score() for run in run_clips(batch.policy, batch.source.load(), batch.perturbation)]
