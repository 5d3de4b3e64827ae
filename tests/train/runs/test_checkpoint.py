import errno
import json

import numpy as np
import pytest
import torch

from tests.train.linear_quadratic import LinearQuadratic, make_learner
from unicon.errors import InputFileError, UniconError
from unicon.train.learning.networks import NetworkConfig
from unicon.train.runs import checkpoint
from unicon.train.runs.checkpoint import checkpoints_of, read_checkpoint, read_networks, write_checkpoint


@pytest.fixture
def learner():
    learner = make_learner(LinearQuadratic(num_envs=32))
    learner.iterate(0.0)
    return learner


def test_a_learner_comes_back_to_the_bit(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, seconds=7.5, keep=2)
    other = make_learner(LinearQuadratic(num_envs=32, seed=5))
    numbers = read_checkpoint(path, other)
    assert (numbers.iteration, numbers.samples, numbers.seconds) == (1, 512, 7.5)
    assert other.ppo.learning_rate == learner.ppo.learning_rate
    for one in (learner, other):
        one.iterate(0.3)
    for (name, a), b in zip(
        learner.network.state_dict().items(), other.network.state_dict().values(), strict=True
    ):
        assert torch.equal(a, b), name
    assert np.array_equal(learner.environment.states, other.environment.states)


def test_it_holds_no_pickle(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    assert sorted(file.name for file in path.iterdir()) == [
        "checkpoint.json",
        "learner.safetensors",
        "process_0.safetensors",
    ]


def test_only_the_newest_are_kept(learner, tmp_path):
    for _ in range(4):
        learner.iterate(0.0)
        write_checkpoint(tmp_path, learner, 0.0, keep=2)
    assert [path.name for path in checkpoints_of(tmp_path)] == ["00000004", "00000005"]


def test_a_full_disk_leaves_the_last_good_one(learner, tmp_path, monkeypatch):
    good = write_checkpoint(tmp_path, learner, 0.0, keep=1)
    learner.iterate(0.0)

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(checkpoint, "save_file", full)
    with pytest.raises(UniconError, match=f"No space left on device.*{good.name}"):
        write_checkpoint(tmp_path, learner, 0.0, keep=1)
    assert checkpoints_of(tmp_path) == [good]
    assert not list((tmp_path / "checkpoints").glob(".*"))


def test_a_half_written_one_does_not_count(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    (path / "checkpoint.json").unlink()
    assert checkpoints_of(tmp_path) == []


def test_other_networks_are_refused_with_both_sizes(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    other = make_learner(LinearQuadratic(num_envs=32), network=NetworkConfig((8,), (8,)))
    with pytest.raises(InputFileError, match=r"\(32, 2\).*\(8, 2\)"):
        read_checkpoint(path, other)


def test_a_damaged_one_is_said_so(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    (path / "learner.safetensors").write_bytes(b"nothing")
    with pytest.raises(InputFileError, match="cannot be read as safetensors"):
        read_checkpoint(path, learner)


def test_one_of_a_newer_format_is_refused(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    file = path / "checkpoint.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "format": 9}))
    with pytest.raises(InputFileError, match="format 9"):
        read_checkpoint(path, learner)


def test_other_environments_are_refused(learner, tmp_path):
    path = write_checkpoint(tmp_path, learner, 0.0, 2)
    with pytest.raises(InputFileError, match="does not fit these environments"):
        read_checkpoint(path, make_learner(LinearQuadratic(num_envs=16)))


def test_fine_tuning_takes_the_networks_and_keeps_its_own_noise(learner, tmp_path):
    write_checkpoint(tmp_path, learner, 0.0, 2)
    fresh = make_learner(LinearQuadratic(num_envs=16))
    fresh.network.log_std.data.fill_(-3.0)
    read_networks(tmp_path, fresh.network)
    assert torch.equal(fresh.network.actor.layers[0].weight, learner.network.actor.layers[0].weight)
    assert torch.equal(fresh.network.normalizer.mean, learner.network.normalizer.mean)
    assert fresh.network.log_std.item() == -3.0
    assert (fresh.iteration, fresh.samples) == (0, 0)
    with pytest.raises(InputFileError, match="holds no checkpoint"):
        read_networks(tmp_path / "nowhere", fresh.network)
