"""Proximal policy optimisation: surrogate, penalty on the Kullback-Leibler divergence, adaptive rates.

With r = pi(a | s) / pi_old(a | s) and the normalised advantage A, what is minimised is

    L = -mean min(r A, clip(r, 1 - c, 1 + c) A) + beta mean KL(pi_old | pi)
        + c_v mean (V - R)^2 - c_e entropy

The paper has the penalty and no clipping; either, both or none are chosen by ``PPOConfig``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor

from unicon.errors import UniconError
from unicon.train.learning.distributed import World
from unicon.train.learning.networks import ActorCritic
from unicon.train.learning.rollout import Batch

MAX_LOG_RATIO = 20.0
"""Beyond it the surrogate would overflow; no useful sample comes near."""


@dataclass(frozen=True)
class PPOConfig:
    """How the policy is improved."""

    gamma: float = 0.95
    """Discount of one control step."""
    lambda_: float = 0.95
    """Of the advantage estimate: 0 trusts the value function, 1 the rewards."""
    scale_rewards: bool = True
    """Times 1 - gamma, so that values stay within 0..1 for rewards within 0..1, whatever gamma is."""
    epochs: int = 2
    """How often each sample is used."""
    minibatch: int = 2048
    """Samples of a gradient step, in each process."""
    clip: float = 0.2
    """c, the ratio is cut off at 1 +- c; 0 does not cut it off."""
    kl_penalty: float = 0.0
    """beta, weight of the divergence in the loss; 0 leaves it out."""
    kl_penalty_adaptive: bool = False
    """Double beta where an update's divergence is above 1.5 kl_target, halve it below kl_target / 1.5."""
    kl_target: float = 0.06
    """Wanted divergence of an update. The customary 0.01 starves a policy of 35 actions."""
    kl_stop: float = 3.0
    """An update ends early when the divergence of an epoch is above this many times the target."""
    learning_rate: float = 3e-4
    """Adam's, at first."""
    learning_rate_adaptive: bool = True
    """Divide it by 1.3 or multiply it by 1.15, by the divergence as above."""
    learning_rate_min: float = 2e-5
    """Lower end of the adaptation."""
    learning_rate_max: float = 1e-3
    """Upper end of the adaptation."""
    value_weight: float = 5.0
    """c_v. Above the customary 0.5, because the scaled returns are small."""
    entropy_weight: float = 0.0
    """c_e; matters only where the deviation is learned."""
    max_gradient_norm: float = 1.0
    """A longer gradient is shortened to it."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        for name, low, high in (
            ("gamma", 0.0, 1.0),
            ("lambda_", 0.0, 1.0),
            ("epochs", 1, 1000),
            ("minibatch", 1, 10**9),
            ("clip", 0.0, 10.0),
            ("kl_penalty", 0.0, 1e6),
            ("kl_target", 1e-9, 1e6),
            ("learning_rate", 1e-9, 10.0),
        ):
            if not low <= getattr(self, name) <= high:
                raise UniconError(f"ppo.{name} is {getattr(self, name)}, expected {low:g} to {high:g}")
        if self.scale_rewards and self.gamma == 1.0:
            raise UniconError("ppo.gamma is 1: set ppo.scale_rewards=false, the scale 1 - gamma would be 0")


class NotFiniteError(ArithmeticError):
    """Something that has to be a number is not; ``batch`` is what was learned from, where there is one."""

    def __init__(self, what: str, batch: Batch | None = None) -> None:
        super().__init__(what)
        self.batch = batch


class Losses(NamedTuple):
    """Parts of the loss of a minibatch, each ``()``."""

    total: Tensor
    surrogate: Tensor
    value: Tensor
    kl: Tensor
    clipped: Tensor
    """Share of the samples whose ratio is cut off."""


class UpdateReport(NamedTuple):
    """What an update did; means over the minibatches of its last epoch."""

    kl: float
    surrogate: float
    value_loss: float
    clipped: float
    gradient_norm: float
    learning_rate: float
    kl_penalty: float
    epochs: int


def gaussian_log_prob(actions: Tensor, means: Tensor, log_std: Tensor) -> Tensor:
    """Return log N(a; mean, std^2) ``(B,)`` = -1/2 sum ((a - mean) / std)^2 - sum log std - A/2 log 2 pi."""
    z = (actions - means) * torch.exp(-log_std)
    return -0.5 * (z * z).sum(-1) - log_std.sum() - 0.5 * len(log_std) * math.log(2.0 * math.pi)


def gaussian_kl(old_means: Tensor, old_log_std: Tensor, means: Tensor, log_std: Tensor) -> Tensor:
    """Return KL(old | new) ``(B,)`` = sum log(s / s_old) + (s_old^2 + (m_old - m)^2) / (2 s^2) - 1/2."""
    difference = (old_means - means) * torch.exp(-log_std)
    change = log_std - old_log_std
    spread = 0.5 * torch.exp(-2.0 * change) - 0.5
    return (change + spread).sum() + 0.5 * (difference * difference).sum(-1)


def surrogate_loss(ratio: Tensor, advantages: Tensor, clip: float) -> Tensor:
    """Return -mean min(r A, clip(r, 1 - c, 1 + c) A), without the cut where c is 0."""
    if clip == 0.0:
        return -(ratio * advantages).mean()
    cut = ratio.clamp(1.0 - clip, 1.0 + clip)
    return -torch.minimum(ratio * advantages, cut * advantages).mean()


class PPO:
    """Improves a network by the samples of an iteration."""

    def __init__(
        self, network: ActorCritic, config: PPOConfig, world: World, generator: torch.Generator
    ) -> None:
        self.network, self.config = network, config
        self.learning_rate, self.kl_penalty = config.learning_rate, config.kl_penalty
        self._world, self._generator = world, generator
        self.parameters = [p for p in network.parameters() if p.requires_grad]
        self.optimizer = torch.optim.Adam(self.parameters, self.learning_rate, eps=1e-5, fused=True)
        self._old_log_std = network.log_std.detach().clone()

    def update(self, batch: Batch) -> UpdateReport:
        """Improve the network.

        Raises:
            NotFiniteError: before a gradient that is not finite reaches the network.
        """
        batch = batch._replace(advantages=self._normalize(batch.advantages))
        self._old_log_std = self.network.log_std.detach().clone()
        for group in self.optimizer.param_groups:
            group["lr"] = self.learning_rate
        means, epochs = torch.zeros(5), 0
        while epochs < self.config.epochs and means[2] <= self.config.kl_stop * self.config.kl_target:
            steps = [self._step(batch.rows(indices)) for indices in self._minibatches(len(batch.returns))]
            means = self._world.sum(torch.stack(steps).mean(dim=0).cpu()) / self._world.size
            epochs += 1
        surrogate, value, kl, clipped, norm = means.tolist()
        report = UpdateReport(
            kl, surrogate, value, clipped, norm, self.learning_rate, self.kl_penalty, epochs
        )
        self._adapt(kl)
        return report

    def losses(self, batch: Batch) -> Losses:
        """Return the loss of samples whose advantages are normalised."""
        config, network = self.config, self.network
        means = network.actor(batch.observations)
        log_ratio = gaussian_log_prob(batch.actions, means, network.log_std) - batch.log_probs
        ratio = log_ratio.clamp(max=MAX_LOG_RATIO).exp()
        surrogate = surrogate_loss(ratio, batch.advantages, config.clip)
        kl = gaussian_kl(batch.means, self._old_log_std, means, network.log_std).mean()
        value = (network.value(batch.observations) - batch.returns).square().mean()
        total = surrogate + self.kl_penalty * kl + config.value_weight * value
        if config.entropy_weight:
            # the entropy of a Gaussian is sum log std + a constant
            total = total - config.entropy_weight * network.log_std.sum()
        clipped = ((ratio.detach() - 1.0).abs() > config.clip).float().mean()
        return Losses(total, surrogate.detach(), value.detach(), kl.detach(), clipped)

    def gradients(self, batch: Batch) -> Losses:
        """Leave the gradients of the loss, averaged over all processes, with the parameters."""
        losses = self.losses(batch)
        self.optimizer.zero_grad(set_to_none=True)
        losses.total.backward()
        self._world.average_gradients(self.parameters)
        return losses

    def _step(self, batch: Batch) -> Tensor:
        losses = self.gradients(batch)
        norm = torch.nn.utils.clip_grad_norm_(self.parameters, self.config.max_gradient_norm)
        if not math.isfinite(float(norm)):
            raise NotFiniteError("the gradient of the loss", batch)
        self.optimizer.step()
        return torch.stack([losses.surrogate, losses.value, losses.kl, losses.clipped, norm])

    def _minibatches(self, count: int) -> Iterator[Tensor]:
        size = min(self.config.minibatch, count)
        device = self.parameters[0].device
        order = torch.randperm(count, generator=self._generator, device=self._generator.device).to(device)
        for start in range(0, count - size + 1, size):
            yield order[start : start + size]

    def _normalize(self, advantages: Tensor) -> Tensor:
        """Return the advantages with mean 0 and deviation 1 over the batches of all processes."""
        count = float(len(advantages) * self._world.size)
        mean = self._world.sum(advantages.sum()) / count
        variance = self._world.sum((advantages - mean).square().sum()) / count
        return (advantages - mean) / (variance.sqrt() + 1e-8)

    def _adapt(self, kl: float) -> None:
        """Follow the measured divergence with the learning rate and the penalty."""
        config = self.config
        much, little = kl > 1.5 * config.kl_target, kl < config.kl_target / 1.5
        if config.learning_rate_adaptive and much:
            self.learning_rate = max(self.learning_rate / 1.3, config.learning_rate_min)
        elif config.learning_rate_adaptive and little:
            self.learning_rate = min(self.learning_rate * 1.15, config.learning_rate_max)
        if config.kl_penalty_adaptive and (much or little):
            self.kl_penalty *= 2.0 if much else 0.5
