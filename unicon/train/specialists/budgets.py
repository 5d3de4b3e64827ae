"""How the minutes of a round are shared out: most goes to where the clips are not followed yet.

    cluster's weight = sum over its clips of (0.2 + 1 - survival under the generalist)

A cluster that masters its clips stops early; what it leaves goes to specialists of single clips.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from unicon.train.specialists.clusters import Cluster
from unicon.train.specialists.config import SpecialistsConfig
from unicon.train.specialists.plan import ClipResult

_EASY = 0.2
"""Weight of a clip that is followed already: its specialist has to keep it."""
_MAX_SINGLE = 2.0
"""A single clip gets at most so many times ``specialists.single_minutes``."""


class Budget(NamedTuple):
    """Minutes of the stages of a round."""

    generalist: float
    clusters: float
    singles: float
    distillation: float
    finetuning: float


def round_budget(minutes: float, config: SpecialistsConfig, first: bool, has_clusters: bool) -> Budget:
    """Return the minutes of the stages.

    Args:
        minutes: of the round.
        config: the shares.
        first: whether the generalist is trained in it.
        has_clusters: whether there are clusters to train; singles get their minutes otherwise.
    """
    total = sum(config.shares)
    generalist, clusters, singles, distillation, finetuning = (
        minutes * share / total for share in config.shares
    )
    if not first:
        generalist, clusters = 0.0, clusters + generalist
    if not has_clusters:
        clusters, singles = 0.0, singles + clusters
    return Budget(generalist, clusters, singles, distillation, finetuning)


def cluster_minutes(
    clusters: Sequence[Cluster], minutes: float, generalist: Mapping[str, ClipResult]
) -> list[float]:
    """Return the minutes of each cluster, by how badly the generalist follows its clips."""
    weights = [sum(_EASY + 1.0 - generalist[clip].survival for clip in c.clips) for c in clusters]
    return [minutes * weight / sum(weights) for weight in weights]


def choose_singles(teachers: Mapping[str, ClipResult], minutes: float, least: float) -> list[str]:
    """Return the clips that get a specialist of their own.

    Of those that are not mastered, the ones that survive longest come first: they are nearest to success.

    Args:
        teachers: how the best specialist of each clip follows it.
        minutes: to be shared.
        least: minutes that each gets at least.
    """
    failing = sorted(
        (name for name, result in teachers.items() if not result.mastered),
        key=lambda name: (-teachers[name].survival, name),
    )
    return failing[: int(minutes / least + 1e-9)]


def single_minutes(minutes: float, count: int, least: float) -> float:
    """Return the minutes of each of so many single clips: an even share, up to twice the least."""
    return min(minutes / count, _MAX_SINGLE * least) if count else 0.0
