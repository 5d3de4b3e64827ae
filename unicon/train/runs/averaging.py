"""The mean of the networks of runs that come from one another, as a run of its own.

    theta = sum_i theta_i / n                (weights, and the normalisation of the input)

PPO with a step that is held at a divergence goes on to move at random where it no longer gets better. Of
networks that lie far apart on one path the mean keeps what they agree on, and loses much of the rest: it
follows more clips than each of them (Wortsman et al. 2022, model soups). Networks of separate beginnings have
no such mean.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import torch

from unicon.errors import UniconError
from unicon.train.runs.checkpoint import CheckpointNumbers, read_networks, write_networks
from unicon.train.runs.recipe import Recipe, read_recipe
from unicon.train.runs.run_folder import CONFIG_FILE, open_run, run_of
from unicon.train.runs.trained_policy import network_of


def average_runs(runs: Sequence[Path], out: Path) -> None:
    """Write a run whose networks are the mean of others; its settings are those of the first.

    Its samples and seconds are the sums of theirs.

    Args:
        runs: folders of two runs or more, or of their checkpoints.
        out: folder of the run to write.

    Raises:
        UniconError: when there are fewer than two, they do not see and do the same, or out holds a run.
        InputFileError: when one cannot be read, or its networks have other sizes.
    """
    if len(runs) < 2:
        raise UniconError(f"{len(runs)} run to average; name two or more")
    recipes = [read_recipe(run_of(run) / CONFIG_FILE) for run in runs]
    for run, recipe in zip(runs, recipes, strict=True):
        if _kind(recipe) != _kind(recipes[0]):
            raise UniconError(f"{run}: sees or does something else than {runs[0]}: {_kind(recipe)}")
    networks = [network_of(recipes[0]) for _ in runs]
    numbers = [read_networks(run, network) for run, network in zip(runs, networks, strict=True)]
    states = [network.state_dict() for network in networks]
    mean = network_of(recipes[0])
    mean.load_state_dict({name: torch.stack([state[name] for state in states]).mean(0) for name in states[0]})
    open_run(out, recipes[0], resume=False)
    write_networks(out, mean, _sum(numbers))


def _kind(recipe: Recipe) -> tuple[object, ...]:
    config = recipe.environment
    return config.action, config.observation, config.stride, recipe.network.activation


def _sum(numbers: Sequence[CheckpointNumbers]) -> CheckpointNumbers:
    first = numbers[0]
    return CheckpointNumbers(
        iteration=0,
        samples=sum(n.samples for n in numbers),
        seconds=sum(n.seconds for n in numbers),
        learning_rate=first.learning_rate,
        kl_penalty=first.kl_penalty,
        processes=first.processes,
    )
