"""Tests for averaging.py."""

from __future__ import annotations

from pathlib import Path

import pytest
import torch

from unicon.errors import InputFileError, UniconError
from unicon.train.learning.networks import ActorCritic
from unicon.train.runs.averaging import average_runs
from unicon.train.runs.checkpoint import CheckpointNumbers, checkpoints_of, read_networks, write_networks
from unicon.train.runs.recipe import read_recipe
from unicon.train.runs.run_folder import open_run
from unicon.train.runs.trained_policy import network_of, read_trained

SMALL = ("network.actor_sizes=[16]", "network.critic_sizes=[16]")


def make_run(folder: Path, value: float, *changes: str) -> ActorCritic:
    """Write a run whose weights are all of one value."""
    recipe = read_recipe("laptop", (*SMALL, *changes))
    network = network_of(recipe)
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.fill_(value)
        network.normalizer.mean.fill_(10.0 * value)
    open_run(folder, recipe, resume=False)
    write_networks(folder, network, CheckpointNumbers(7, 1_000_000, 1800.0, 1e-4, 0.0, 1))
    return network


def test_the_mean_has_their_weights_and_normalisation_and_all_their_samples(tmp_path):
    runs = [tmp_path / name for name in ("a", "b", "c")]
    for run, value in zip(runs, (0.0, 0.3, 0.6), strict=True):
        network = make_run(run, value)
    average_runs(runs, tmp_path / "mean")
    numbers = read_networks(tmp_path / "mean", network)
    assert torch.allclose(network.actor.layers[0].weight, torch.tensor(0.3))
    assert torch.allclose(network.critic.layers[1].bias, torch.tensor(0.3))
    assert torch.allclose(network.normalizer.mean, torch.tensor(3.0))
    assert (numbers.iteration, numbers.samples, numbers.seconds) == (0, 3_000_000, 5400.0)


def test_it_is_exported_as_any_run_and_a_checkpoint_is_as_good(tmp_path):
    make_run(tmp_path / "a", 0.1)
    make_run(tmp_path / "b", 0.2)
    average_runs([tmp_path / "a", checkpoints_of(tmp_path / "b")[0]], tmp_path / "mean")
    card, weights = read_trained(tmp_path / "mean", "mean")
    assert weights.layers[0][0] == pytest.approx(0.15)
    assert "2.0 M samples in 1.00 h" in card.training


def test_what_cannot_be_averaged_is_refused(tmp_path):
    make_run(tmp_path / "a", 0.1)
    make_run(tmp_path / "torque", 0.1, "environment.action=torque")
    make_run(tmp_path / "wide", 0.1, "network.actor_sizes=[32]")
    with pytest.raises(UniconError, match="1 run to average; name two or more"):
        average_runs([tmp_path / "a"], tmp_path / "mean")
    with pytest.raises(UniconError, match="sees or does something else"):
        average_runs([tmp_path / "a", tmp_path / "torque"], tmp_path / "mean")
    with pytest.raises(InputFileError, match="layers of the sizes"):
        average_runs([tmp_path / "a", tmp_path / "wide"], tmp_path / "mean")
    with pytest.raises(InputFileError, match="nowhere: holds no config.yaml"):
        average_runs([tmp_path / "a", tmp_path / "nowhere"], tmp_path / "mean")
    assert not (tmp_path / "mean").exists()
    with pytest.raises(UniconError, match="holds a run already"):
        average_runs([tmp_path / "a", tmp_path / "a"], tmp_path / "a")
