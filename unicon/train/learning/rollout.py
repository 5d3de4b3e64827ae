"""What one iteration collects: T steps of N environments, and the advantages computed from them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from unicon.train.environment.vector_environment import EnvironmentStep
from unicon.train.learning.networks import ActorCritic


class Batch(NamedTuple):
    """Samples to learn from, B rows."""

    observations: Tensor
    """``(B, O)``, normalised."""
    actions: Tensor
    """``(B, A)``."""
    means: Tensor
    """``(B, A)``: the policy's means when it acted."""
    log_probs: Tensor
    """``(B,)``: log pi(a | s) then."""
    advantages: Tensor
    """``(B,)``."""
    returns: Tensor
    """``(B,)``: what the value function should say."""

    def rows(self, indices: Tensor) -> Batch:
        """Return some of the rows."""
        return Batch(*(tensor.index_select(0, indices) for tensor in self))


class Advantages(NamedTuple):
    """Results of ``generalized_advantages``, each ``(T, N)``."""

    advantages: Tensor
    returns: Tensor


def generalized_advantages(
    rewards: Tensor,
    values: Tensor,
    next_values: Tensor,
    dones: Tensor,
    gamma: float,
    lambda_: float,
) -> Advantages:
    """Return generalised advantage estimates (Schulman et al. 2016, eq. 11 and 16).

    Args:
        rewards: r_t ``(T, N)``.
        values: V(s_t) ``(T, N)``.
        next_values: value of what came after step t ``(T, N)``: 0 where it terminated, V of the last
            observation where it was truncated, else V(s_{t+1}).
        dones: whether the episode ended with step t ``(T, N)``.
        gamma: discount of a step.
        lambda_: 0 trusts the values, 1 the rewards.
    """
    advantages = torch.empty_like(rewards)
    following = torch.zeros_like(rewards[0])
    going_on = (~dones).to(rewards.dtype)
    for t in range(len(rewards) - 1, -1, -1):
        # delta_t = r_t + gamma V'_{t+1} - V(s_t)
        delta = rewards[t] + gamma * next_values[t] - values[t]
        # A_t = delta_t + gamma lambda (1 - done_t) A_{t+1}
        following = delta + gamma * lambda_ * going_on[t] * following
        advantages[t] = following
    # R_t = A_t + V(s_t)
    return Advantages(advantages, advantages + values)


class Rollout:
    """Room for T steps of N environments; written anew in each iteration."""

    def __init__(
        self,
        steps: int,
        num_envs: int,
        observation_size: int,
        action_size: int,
        dtype: torch.dtype,
        device: torch.device,
    ) -> None:
        def room(*shape: int, dtype: torch.dtype = torch.float32) -> Tensor:
            return torch.zeros(shape, dtype=dtype, device=device)

        self.steps = steps
        self.observations = room(steps + 1, num_envs, observation_size, dtype=dtype)
        """Normalised; the last is what follows."""
        self.actions = room(steps, num_envs, action_size)
        self.means = room(steps, num_envs, action_size)
        self.log_probs = room(steps, num_envs)
        self.rewards = room(steps, num_envs)
        self.terminated = room(steps, num_envs, dtype=torch.bool)
        self.truncated = room(steps, num_envs, dtype=torch.bool)
        self.values = room(steps, num_envs)
        self.advantages = room(steps, num_envs)
        self.returns = room(steps, num_envs)
        self._final: list[Tensor] = []

    def begin(self) -> None:
        """Forget the last observations of the episodes of the iteration before."""
        self._final = []

    def record(self, t: int, step: EnvironmentStep, network: ActorCritic) -> None:
        """Keep what the world answered to the actions of step t."""
        self.rewards[t].copy_(torch.from_numpy(step.reward))
        truncated = step.truncated & ~step.terminated
        self.terminated[t].copy_(torch.from_numpy(step.terminated))
        self.truncated[t].copy_(torch.from_numpy(truncated))
        if truncated.any():
            rows = np.ascontiguousarray(step.final_observation[truncated], np.float32)
            final = network.normalizer(torch.from_numpy(rows).to(self.rewards.device))
            self._final.append(final.to(self.observations.dtype))

    @torch.no_grad()
    def compute_returns(
        self, network: ActorCritic, gamma: float, lambda_: float, reward_scale: float
    ) -> None:
        """Fill in values, advantages and returns."""
        following = network.value(self.observations)  # (T + 1, N)
        self.values.copy_(following[:-1])
        next_values = following[1:].masked_fill(self.terminated, 0.0)
        if self._final:
            next_values[self.truncated] = network.value(torch.cat(self._final))
        dones = self.terminated | self.truncated
        self.advantages, self.returns = generalized_advantages(
            self.rewards * reward_scale, self.values, next_values, dones, gamma, lambda_
        )

    def batch(self) -> Batch:
        """Return all steps of all environments as rows; nothing is copied."""
        return Batch(
            observations=self.observations[:-1].flatten(0, 1),
            actions=self.actions.flatten(0, 1),
            means=self.means.flatten(0, 1),
            log_probs=self.log_probs.flatten(),
            advantages=self.advantages.flatten(),
            returns=self.returns.flatten(),
        )
