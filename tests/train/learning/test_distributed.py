import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest
import torch
from safetensors.torch import load_file, save_file

from tests.train.distributed_worker import gradients
from tests.train.linear_quadratic import make_learner
from unicon.errors import UniconError
from unicon.train.learning.distributed import World, join_world
from unicon.train.learning.normalizer import moments_of

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Two processes on this machine's loopback that learn together; the whole batch and their results."""
    folder = tmp_path_factory.mktemp("two")
    learner = make_learner()
    learner.start()
    learner.collect()
    learner.compute_returns()
    batch = learner.rollout.batch()
    save_file({k: v.contiguous() for k, v in batch._asdict().items()}, folder / "batch.safetensors")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    shared = {"WORLD_SIZE": "2", "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": port, "GLOO_SOCKET_IFNAME": "lo"}
    processes = [
        subprocess.Popen(
            [sys.executable, "-m", "tests.train.distributed_worker", str(folder)],
            cwd=ROOT,
            env={**os.environ, **shared, "RANK": str(rank), "OMP_NUM_THREADS": "1"},
            stderr=subprocess.PIPE,
            text=True,
        )
        for rank in range(2)
    ]
    for process in processes:
        _, errors = process.communicate(timeout=100)
        assert process.returncode == 0, errors
    return batch, [load_file(folder / f"{rank}.safetensors") for rank in range(2)], folder


def test_two_processes_have_the_gradients_of_one_with_both_halves(run):
    batch, results, _ = run
    expected = gradients(make_learner(), batch)
    assert any(gradient.abs().max() > 1e-3 for gradient in expected.values())
    for result in results:
        for name, gradient in expected.items():
            assert torch.allclose(result[name], gradient, atol=1e-5), name


def test_the_normalisation_is_that_of_both_halves(run):
    batch, results, _ = run
    expected = moments_of(batch.observations)
    for result in results:
        assert result["count"].item() == len(batch.observations)
        assert torch.allclose(result["mean"], expected.mean)
        assert torch.allclose(result["variance"], expected.variance)


def test_after_learning_together_both_have_the_same_network_to_the_bit(run):
    _, (one, other), _ = run
    names = [name for name in one if name.startswith("network.")]
    assert len(names) > 10
    assert all(torch.equal(one[name], other[name]) for name in names)
    assert one["samples"].item() == 2 * 2 * 16 * 64


def test_a_flag_of_one_process_is_seen_by_all(run):
    for result in run[1]:
        assert result["any"].tolist() == [1, 0]


def test_the_checkpoint_has_the_environments_of_both(run):
    (path,) = (run[2] / "checkpoints").iterdir()
    assert {"process_0.safetensors", "process_1.safetensors"} < {file.name for file in path.iterdir()}


def test_alone_a_process_is_the_whole_world(monkeypatch):
    monkeypatch.delenv("WORLD_SIZE", raising=False)
    world = join_world(torch.device("cpu"))
    assert (world.size, world.leads) == (1, True)
    assert World().any([True, False]) == [True, False]
    assert World().mean(0.25) == 0.25


def test_processes_that_do_not_find_each_other_are_told_to_use_torchrun(monkeypatch):
    monkeypatch.setenv("WORLD_SIZE", "2")
    for name in ("RANK", "MASTER_ADDR", "MASTER_PORT"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(UniconError, match="start them with torchrun"):
        join_world(torch.device("cpu"))
