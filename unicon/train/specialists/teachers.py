"""Frozen specialists, each asked about the avatars that play its clips."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from unicon.errors import UniconError
from unicon.train.learning.networks import ActorCritic
from unicon.train.runs.checkpoint import read_networks
from unicon.train.runs.recipe import read_recipe
from unicon.train.runs.run_folder import CONFIG_FILE


class Advice(NamedTuple):
    """What the teachers say."""

    actions: Tensor
    """Their means ``(N, A)``, float32."""
    values: Tensor
    """What they expect to come ``(N,)``, float32."""


class Teachers:
    """Networks, and which of them teaches each clip of a data set."""

    def __init__(self, networks: Sequence[ActorCritic], of_clip: np.ndarray, dtype: torch.dtype) -> None:
        """Freeze the networks.

        Args:
            networks: K of them, of the same inputs.
            of_clip: which one teaches each clip ``(C,)``.
            dtype: of their hidden layers.
        """
        self.networks = [network.requires_grad_(False).eval() for network in networks]
        self.of_clip = np.asarray(of_clip, np.int64)
        self._dtype = dtype

    @torch.no_grad()
    def advise(self, observations: Tensor, clips: np.ndarray) -> Advice:
        """Return what each avatar's teacher would do.

        Args:
            observations: raw ``(N, O)``.
            clips: place in the data set of the clip that each plays ``(N,)``.
        """
        asked = self.of_clip[clips]
        outputs = self.networks[0].log_std
        advice = Advice(outputs.new_empty(len(asked), len(outputs)), outputs.new_empty(len(asked)))
        for index in np.unique(asked):
            network = self.networks[index]
            rows = torch.from_numpy(np.flatnonzero(asked == index)).to(outputs.device)
            seen = network.normalizer(observations[rows]).to(self._dtype)
            advice.actions[rows] = network.actor(seen)
            advice.values[rows] = network.value(seen)
        return advice


def read_teachers(
    folders: Mapping[str, Path],
    clips: Sequence[str],
    observation_size: int,
    action_size: int,
    dtype: torch.dtype,
    device: torch.device,
) -> Teachers:
    """Read specialists from their runs.

    Args:
        folders: the run of the teacher of each clip, by the clip's name.
        clips: names of the clips of the data set, in its order.
        observation_size: O.
        action_size: A.
        dtype: of their hidden layers.
        device: where they are computed.

    Raises:
        InputFileError: when a run has no checkpoint or it is damaged.
        UniconError: when a clip has no teacher.
    """
    untaught = [clip for clip in clips if clip not in folders]
    if untaught:
        raise UniconError(f"{len(untaught)} clips have no teacher, {untaught[0]!r} first; train specialists")
    order = sorted({folders[clip] for clip in clips})
    networks = []
    for folder in order:
        network = ActorCritic(observation_size, action_size, read_recipe(folder / CONFIG_FILE).network)
        read_networks(folder, network)
        networks.append(network.to(device))
    return Teachers(networks, np.array([order.index(folders[clip]) for clip in clips]), dtype)
