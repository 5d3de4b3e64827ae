import math
from dataclasses import replace

import numpy as np
import pytest
import torch

from tests.train.pfnn.toy_gait import make_toy_data
from unicon.errors import UniconError
from unicon.schedulers.pfnn.layout import OUTPUT_SIZE
from unicon.train.pfnn.training import NetworkTrainer
from unicon.train.pfnn.training_config import LossWeights, NetworkTrainingConfig

CONFIG = NetworkTrainingConfig(hidden=24, minibatch=64, learning_rate=3e-3)
PLAIN = replace(CONFIG, dropout=0.0, path_dropout=0.0, pose_noise=0.0, l1=0.0)


@pytest.fixture(scope="module")
def data():
    return make_toy_data()


def test_it_learns_and_knows_a_take_that_it_has_not_seen(data):
    trainer = NetworkTrainer(data, CONFIG)
    before = trainer.judge()
    for _ in range(300):
        trainer.step(0.0)
    after = trainer.judge()
    assert before.loss > 0.3
    assert after.loss < 0.05
    assert after.parts["joint_pos"] < 0.3 * before.parts["joint_pos"]


def test_the_loss_is_the_weighted_mean_square_of_the_normalised_error(data):
    only = LossWeights(*[0.0] * 9, joint_vel=2.0)
    trainer = NetworkTrainer(data, replace(PLAIN, loss=only))
    error = trainer.judge()
    assert error.loss == pytest.approx(error.shares["joint_vel"])
    both = replace(only, root_vel_h=6.0)
    error = NetworkTrainer(data, replace(PLAIN, loss=both)).judge()
    assert error.loss == pytest.approx(0.25 * error.shares["joint_vel"] + 0.75 * error.shares["root_vel_h"])


def test_errors_have_the_units_of_the_output(data):
    trainer = NetworkTrainer(data, PLAIN)
    for layer in trainer.network.layers:
        layer.weight.data.zero_()
    error = trainer.judge()  # it answers the mean
    walked = data.outputs[data.held_out][:, :2] - data.outputs[~data.held_out][:, :2].mean(axis=0)
    assert error.parts["root_vel_h"] == pytest.approx(np.sqrt(np.square(walked).mean()), rel=1e-4)


def test_held_out_takes_teach_nothing(data):
    spoilt = data._replace(outputs=np.where(data.held_out[:, None], 100.0, data.outputs).astype(np.float32))
    one, other = NetworkTrainer(data, CONFIG), NetworkTrainer(spoilt, CONFIG)
    for _ in range(5):
        assert torch.equal(one.step(0.0), other.step(0.0))
    assert one.judge().loss < other.judge().loss
    assert one.samples == (900, 300)


def test_the_same_seed_gives_the_same_and_another_something_else(data):
    losses = [float(NetworkTrainer(data, replace(CONFIG, seed=seed)).step(0.0)) for seed in (3, 3, 4)]
    assert losses[0] == losses[1] != losses[2]


def test_dropout_keeps_the_mean_and_noise_moves_the_pose_alone(data):
    config = replace(CONFIG, dropout=0.25, path_dropout=0.5, pose_noise=0.0)
    dropped = NetworkTrainer(data, config)._disturb(torch.ones(400, 305))
    path, pose = dropped[:, :108], dropped[:, 108:]
    assert path.unique().tolist() == pytest.approx([0.0, 2.0])
    assert pose.unique().tolist() == pytest.approx([0.0, 4 / 3])
    assert (float(path.mean()), float(pose.mean())) == pytest.approx((1.0, 1.0), abs=0.02)
    config = replace(PLAIN, pose_noise=0.2, pose_scale=0.5)
    noisy = NetworkTrainer(data, config)._disturb(torch.zeros(500, 305))
    assert not noisy[:, :108].any()
    assert noisy[:, 108:].std() == pytest.approx(0.1, rel=0.02)


def test_the_rate_falls_along_half_a_cosine(data):
    trainer = NetworkTrainer(data, replace(CONFIG, learning_rate=1e-3, learning_rate_end=1e-4))
    rates = [trainer.learning_rate(progress) for progress in (0.0, 0.5, 1.0)]
    assert rates == pytest.approx([1e-3, 5.5e-4, 1e-4])
    trainer.step(1.0)
    assert trainer.optimizer.param_groups[0]["lr"] == pytest.approx(1e-4)


def test_data_that_cannot_be_learned_from_are_refused(data):
    with pytest.raises(UniconError, match="no samples to train on"):
        NetworkTrainer(data._replace(held_out=np.ones(1200, bool)), CONFIG)
    bad = data.outputs.copy()
    bad[7, 7] = math.nan
    with pytest.raises(UniconError, match="the outputs of the training data are not all finite"):
        NetworkTrainer(data._replace(outputs=bad), CONFIG)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dropout": 1.0}, "training.dropout is 1.0, expected 0 to below 1"),
        ({"hidden": 0}, "training.hidden is 0, expected 1 or more"),
        ({"minutes": -1.0}, "training.minutes is -1.0, expected 0 or more"),
        ({"pose_scale": 0.0}, "training.pose_scale is 0.0, expected above 0"),
    ],
)
def test_settings_out_of_range_are_refused(changes, message):
    with pytest.raises(UniconError, match=message):
        NetworkTrainingConfig(**changes)


def test_without_weights_there_is_nothing_to_learn(data):
    with pytest.raises(UniconError, match="expected weights"):
        NetworkTrainer(data, replace(CONFIG, loss=LossWeights(*[0.0] * 10)))
    assert len(data.outputs[0]) == OUTPUT_SIZE
