"""What the card of a trained network says of where it comes from: sources with licences, takes, limits."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import RATE_HZ, ClipInfo
from unicon.schedulers.pfnn.layout import GAITS, LAYOUT_ID
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
from unicon.train.pfnn.trained_limits import gait_speeds_of, limits_of
from unicon.train.pfnn.training_config import NetworkTrainingConfig
from unicon.train.runs.run_folder import git_commit

if TYPE_CHECKING:
    from unicon.train.pfnn.training_data import TrainingData


def card_of_data(name: str, data: TrainingData, infos: Sequence[ClipInfo], seed: int) -> PhaseNetworkCard:
    """Return the card of a network that is going to be trained on data made of a library's clips."""
    rows = ~data.held_out
    learned, held_out = (_takes(data, which) for which in (rows, data.held_out))
    return PhaseNetworkCard(
        name=name,
        description="Makes the next pose of a walk from the last one and the path ahead (PFNN).",
        layout_id=LAYOUT_ID,
        humanoid_id=HUMANOID.id,
        gaits=GAITS,
        training_data=_sources(data, rows, infos),
        takes=learned,
        held_out_takes=held_out,
        limits=limits_of(data.outputs[rows]),
        gait_speeds_m_s=gait_speeds_of(data.inputs[rows], data.outputs[rows]),
        commit=git_commit() or "",
        seed=seed,
    )


def training_in_words(config: NetworkTrainingConfig, steps: int, seconds: float) -> str:
    """Return how a network was trained so far."""
    return (
        f"{steps * config.minibatch / 1e6:.2f} M samples in {steps} steps of {config.minibatch}, "
        f"{seconds / 60.0:.1f} min; Adam {config.learning_rate:g} to {config.learning_rate_end:g}, "
        f"dropout {config.dropout:g} (path {config.path_dropout:g}), noise {config.pose_noise:g}"
    )


def _takes(data: TrainingData, rows: np.ndarray) -> tuple[str, ...]:
    return tuple(data.names[index] for index in np.unique(data.sequences[rows]))


def _sources(data: TrainingData, rows: np.ndarray, infos: Sequence[ClipInfo]) -> tuple[str, ...]:
    """Return a line for each source: its licence, and how many takes and minutes were made of it."""
    indices, frames = np.unique(data.sequences[rows], return_counts=True)
    groups: dict[tuple[str, str], list[int]] = defaultdict(list)
    for index, count in zip(indices, frames, strict=True):
        info = _clip_of(data.names[index], infos)
        groups[(info.source, info.licence) if info else ("unknown", "unknown")].append(int(count))
    return tuple(
        f"{source or 'no source given'} (licence: {licence or 'not given'}): {len(counts)} takes and "
        f"variants, {sum(counts) / RATE_HZ / 60.0:.1f} min"
        for (source, licence), counts in sorted(groups.items())
    )


def _clip_of(take: str, infos: Sequence[ClipInfo]) -> ClipInfo | None:
    """Return the clip that a take was made of: the longest name that the take's begins with."""
    fitting = (info for info in infos if take.startswith(info.name))
    return max(fitting, key=lambda info: len(info.name), default=None)
