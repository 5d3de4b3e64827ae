import math

import numpy as np
import pytest
import torch

from tests.train.linear_quadratic import (
    A,
    B,
    LinearQuadratic,
    R,
    discounted_cost,
    make_learner,
    riccati,
)
from unicon.errors import UniconError
from unicon.train.learning.learner import LearnerConfig
from unicon.train.learning.ppo import NotFiniteError, PPOConfig
from unicon.train.learning.variance_controller import VarianceConfig


def test_the_policy_and_the_values_reach_the_known_optimum():
    learner, gamma = make_learner(), 0.9
    for index in range(100):
        learner.iterate(index / 100)

    def act(states):
        with torch.no_grad():
            return learner.network.act(torch.from_numpy(states).float()).double().numpy()

    p = riccati(gamma)
    gain = np.linalg.solve(R + gamma * B.T @ p @ B, gamma * B.T @ p @ A)
    states = np.random.default_rng(1).standard_normal((500, 2))
    costs = np.einsum("ni,ij,nj->n", states, p, states)
    assert discounted_cost(lambda s: -s @ gain.T, states, gamma) == pytest.approx(costs.mean(), rel=1e-6)
    assert discounted_cost(act, states, gamma) < 1.06 * costs.mean()
    with torch.no_grad():
        seen = learner.network.normalizer(torch.from_numpy(states).float())
        values = learner.network.value(seen).numpy() / (1.0 - gamma)
    assert np.corrcoef(values, -costs)[0, 1] > 0.97


def test_the_noise_follows_the_schedule_and_is_not_learned():
    learner = make_learner(variance=VarianceConfig(points=((0.0, 0.4), (1.0, 0.1))))
    assert learner.iterate(0.0).std == pytest.approx(0.4)
    assert learner.iterate(0.5).std == pytest.approx(0.2)
    noise = (learner.rollout.actions - learner.rollout.means).std().item()
    assert noise == pytest.approx(0.2, rel=0.05)


def test_as_an_ablation_the_noise_is_learned_from_the_first_point_on():
    learner = make_learner(variance=VarianceConfig(mode="learned", points=((0.0, 0.4), (1.0, 0.1))))
    assert learner.network.log_std.exp().item() == pytest.approx(0.4)
    std = [learner.iterate(0.9).std for _ in range(5)][-1]
    assert std != pytest.approx(0.4, rel=1e-4)
    assert std > 0.2


def test_the_log_probabilities_kept_are_those_of_the_policy_that_acted():
    learner = make_learner()
    learner.start()
    learner.collect()
    learner.compute_returns()
    batch = learner.rollout.batch()
    losses = learner.ppo.losses(batch)
    assert losses.kl.item() == pytest.approx(0.0, abs=1e-6)
    assert losses.surrogate.item() == pytest.approx(-batch.advantages.mean().item(), abs=1e-4)


def test_the_report_counts_samples_and_episodes():
    learner = make_learner(LinearQuadratic(num_envs=40), learner=LearnerConfig(steps=20, threads=1))
    report = learner.iterate(0.0)
    assert (report.iteration, report.samples) == (1, 800)
    assert learner.iterate(0.0).samples == 1600
    assert 0 < report.episodes.length <= 20
    assert report.episodes.survival == 1.0
    assert report.episodes.terms.root_position == pytest.approx(
        np.exp(learner.rollout.rewards.numpy()).mean(), abs=0.5
    )


def test_equal_seeds_give_equal_policies_and_others_do_not():
    networks = []
    for seed in (1, 1, 2):
        learner = make_learner(learner=LearnerConfig(seed=seed, threads=1, precision="fp32"))
        learner.iterate(0.0)
        networks.append(learner.network.actor.layers[0].weight)
    assert torch.equal(networks[0], networks[1])
    assert not torch.equal(networks[0], networks[2])


def test_a_reward_that_is_not_finite_is_found():
    learner = make_learner(LinearQuadratic(bad_at=18))
    learner.iterate(0.0)
    with pytest.raises(NotFiniteError, match="a reward") as caught:
        learner.iterate(0.0)
    assert caught.value.batch is not None


def test_with_bfloat16_it_learns_as_well():
    learner = make_learner(learner=LearnerConfig(threads=1, precision="bf16"))
    assert learner.rollout.observations.dtype == torch.bfloat16
    rewards = [learner.iterate(index / 30).episodes.reward for index in range(30)]
    assert rewards[-1] > 0.5 * rewards[2]  # costs, below 0


def test_rewards_are_scaled_so_that_values_stay_within_0_and_1():
    learner = make_learner(ppo=PPOConfig(gamma=0.5, lambda_=1.0, minibatch=1024))
    learner.iterate(0.0)
    unscaled = make_learner(ppo=PPOConfig(gamma=0.5, lambda_=1.0, minibatch=1024, scale_rewards=False))
    unscaled.iterate(0.0)
    ratio = unscaled.rollout.returns.mean() / learner.rollout.returns.mean()
    assert ratio.item() == pytest.approx(2.0, rel=0.05)


def test_a_gpu_that_is_not_there_is_said_so(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(UniconError, match="finds no GPU"):
        make_learner(learner=LearnerConfig(device="cuda"))


def test_a_schedule_for_other_joints_is_refused():
    with pytest.raises(UniconError, match="joint_factors"):
        make_learner(variance=VarianceConfig(joint_factors=(1.0, 1.0)))
    assert math.isclose(make_learner().network.log_std.exp().item(), 0.5, rel_tol=1e-6)
