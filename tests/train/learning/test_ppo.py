import math

import pytest
import torch
from scipy.stats import norm

from unicon.errors import UniconError
from unicon.train.learning.distributed import World
from unicon.train.learning.networks import ActorCritic, NetworkConfig
from unicon.train.learning.ppo import (
    PPO,
    NotFiniteError,
    PPOConfig,
    gaussian_kl,
    gaussian_log_prob,
    surrogate_loss,
)
from unicon.train.learning.rollout import Batch


def _ppo(**changes):
    torch.manual_seed(0)
    network = ActorCritic(5, 3, NetworkConfig((16,), (16,), actor_gain=1.0))
    network.log_std.data.fill_(math.log(0.5))
    config = PPOConfig(**{"minibatch": 64, **changes})
    return PPO(network, config, World(), torch.Generator().manual_seed(0))


def _batch(ppo, count=256):
    observations = torch.randn(count, 5)
    with torch.no_grad():
        means = ppo.network.actor(observations)
        actions = means + 0.5 * torch.randn_like(means)
        log_probs = gaussian_log_prob(actions, means, ppo.network.log_std)
    advantages = actions[:, 0] + 0.1 * torch.randn(count)
    return Batch(observations, actions, means, log_probs, advantages, torch.randn(count))


def test_log_probabilities_are_scipys():
    actions, means = torch.tensor([[0.3, -1.0]]), torch.tensor([[0.1, 0.5]])
    deviations = torch.tensor([0.2, 2.0])
    expected = norm.logpdf(actions.numpy(), means.numpy(), deviations.numpy()).sum()
    found = gaussian_log_prob(actions, means, deviations.log())
    assert found.item() == pytest.approx(expected, rel=1e-6)


def test_the_divergence_is_that_of_a_hand_calculation():
    # N(0, 1) against N(1, 2^2): log 2 + (1 + 1) / 8 - 1/2
    one = torch.zeros(1, 1)
    found = gaussian_kl(one, torch.zeros(1), one + 1.0, torch.tensor([math.log(2.0)]))
    assert found.item() == pytest.approx(math.log(2.0) + 0.25 - 0.5, rel=1e-6)


def test_the_divergence_of_a_policy_from_itself_is_0():
    means, log_std = torch.randn(4, 3), torch.randn(3)
    assert torch.allclose(gaussian_kl(means, log_std, means, log_std), torch.zeros(4))


def test_the_surrogate_is_cut_off_only_where_it_would_gain():
    ratio = torch.tensor([1.5, 1.5, 0.5, 0.5])
    advantages = torch.tensor([1.0, -1.0, 1.0, -1.0])
    # min(1.5, 1.2), min(-1.5, -1.2), min(0.5, 0.8), min(-0.5, -0.8)
    assert surrogate_loss(ratio, advantages, 0.2).item() == pytest.approx(-(1.2 - 1.5 + 0.5 - 0.8) / 4)
    assert surrogate_loss(ratio, advantages, 0.0).item() == pytest.approx(0.0)


def test_at_the_old_policy_the_gradient_is_the_policy_gradient():
    ppo = _ppo(value_weight=0.0)
    batch = _batch(ppo)
    ppo.gradients(batch)
    found = [p.grad.clone() for p in ppo.network.actor.parameters()]
    ppo.network.zero_grad()
    log_probs = gaussian_log_prob(batch.actions, ppo.network.actor(batch.observations), ppo.network.log_std)
    (-(log_probs * batch.advantages).mean()).backward()
    for one, param in zip(found, ppo.network.actor.parameters(), strict=True):
        assert torch.allclose(one, param.grad, atol=1e-5)


def test_an_update_makes_better_actions_likelier_and_values_truer():
    ppo = _ppo(epochs=5, kl_stop=100.0)
    batch = _batch(ppo)
    before = ppo.losses(batch)
    ppo.update(batch)
    after = ppo.losses(batch)
    with torch.no_grad():
        gain = ppo.network.actor(batch.observations)[:, 0] - batch.means[:, 0]
    assert gain.mean() > 0.02  # the advantage is the first action
    assert after.value < before.value


def test_a_heavier_penalty_keeps_the_policy_nearer():
    moved = []
    for penalty in (0.0, 30.0):
        ppo = _ppo(clip=0.0, kl_penalty=penalty, epochs=10, kl_stop=1e9, learning_rate=3e-3)
        moved.append(ppo.update(_batch(ppo)).kl)
    assert moved[1] < 0.5 * moved[0]


def test_an_update_ends_early_when_the_policy_moved_too_far():
    ppo = _ppo(epochs=50, kl_target=1e-4, kl_stop=2.0)
    assert ppo.update(_batch(ppo)).epochs < 5


def test_the_learning_rate_follows_the_measured_divergence():
    rates = {}
    for target in (1e-8, 1e3):
        ppo = _ppo(kl_target=target)
        ppo.update(_batch(ppo))
        rates[target] = ppo.learning_rate
    assert rates[1e-8] == pytest.approx(3e-4 / 1.3)
    assert rates[1e3] == pytest.approx(3e-4 * 1.15)


def test_the_penalty_doubles_and_halves_with_the_measured_divergence():
    penalties = {}
    for target in (1e-8, 1e3):
        ppo = _ppo(kl_target=target, kl_penalty=1.0, kl_penalty_adaptive=True)
        ppo.update(_batch(ppo))
        penalties[target] = ppo.kl_penalty
    assert penalties == {1e-8: 2.0, 1e3: 0.5}


def test_each_epoch_uses_every_sample_once():
    ppo = _ppo(minibatch=50)
    parts = list(ppo._minibatches(200))
    assert [len(part) for part in parts] == [50] * 4
    assert sorted(torch.cat(parts).tolist()) == list(range(200))


def test_advantages_are_normalised():
    advantages = _ppo()._normalize(torch.tensor([1.0, 2.0, 6.0]))
    assert advantages.mean().item() == pytest.approx(0.0, abs=1e-6)
    assert advantages.square().mean().item() == pytest.approx(1.0, abs=1e-5)


def test_what_is_not_finite_never_reaches_the_network():
    ppo = _ppo()
    batch = _batch(ppo)
    batch.returns[3] = float("nan")
    with pytest.raises(NotFiniteError) as caught:
        ppo.update(batch)
    assert caught.value.batch is not None
    assert all(torch.isfinite(p).all() for p in ppo.network.parameters())


def test_a_learned_deviation_shrinks_where_noise_does_harm():
    ppo = _ppo()
    ppo.network.log_std.requires_grad_(True)
    ppo = PPO(ppo.network, PPOConfig(minibatch=64, kl_stop=100.0), World(), torch.Generator())
    batch = _batch(ppo)
    harm = -((batch.actions - batch.means) ** 2).sum(-1)
    ppo.update(batch._replace(advantages=harm))
    assert (ppo.network.log_std < math.log(0.5)).all()


@pytest.mark.parametrize(
    ("setting", "value"), [("gamma", 1.5), ("epochs", 0), ("clip", -0.1), ("learning_rate", 0.0)]
)
def test_settings_out_of_their_range_are_refused(setting, value):
    with pytest.raises(UniconError, match=f"ppo.{setting} is {value}"):
        PPOConfig(**{setting: value})
