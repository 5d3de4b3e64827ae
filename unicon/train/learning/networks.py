"""The policy and its critic: two multi-layer perceptrons on the normalised observation.

    pi(a | s) = N(a; actor(z), diag(std^2)),   V(s) = critic(z),   z = clip((s - mean) / std_s, +-5)

The hidden layers compute in the type of their input, bfloat16 where the learner says so; the last layer
and all that follows in float32.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from unicon.policy_file import PolicyWeights
from unicon.train.learning.normalizer import RunningNormalizer

ACTIVATIONS = {
    "relu": functional.relu,
    "elu": functional.elu,
    "silu": functional.silu,
    "tanh": torch.tanh,
}


@dataclass(frozen=True)
class NetworkConfig:
    """Sizes of the two networks."""

    actor_sizes: tuple[int, ...] = (256, 256)
    """Units of the policy's hidden layers."""
    critic_sizes: tuple[int, ...] = (128, 128)
    """Units of the value function's hidden layers."""
    activation: Literal["relu", "elu", "silu", "tanh"] = "relu"
    """After every hidden layer."""
    actor_gain: float = 0.01
    """Gain of the policy's last layer at first: small, so that training begins at zero action."""
    critic_gain: float = 0.1
    """Gain of the value function's last layer at first."""
    normalization_memory: float = 3e6
    """As how many samples the past counts at most in the running normalisation of the observation."""


class Mlp(nn.Module):
    """A multi-layer perceptron with orthogonal weights at first."""

    layers: Sequence[nn.Linear]

    def __init__(self, sizes: Sequence[int], activation: str, last_gain: float) -> None:
        super().__init__()
        self._activation = ACTIVATIONS[activation]
        layers = [nn.Linear(a, b) for a, b in zip(sizes, sizes[1:], strict=False)]
        self.layers = nn.ModuleList(layers)  # type: ignore[assignment]
        for index, layer in enumerate(self.layers):
            last = index == len(self.layers) - 1
            nn.init.orthogonal_(layer.weight, last_gain if last else math.sqrt(2.0))
            nn.init.zeros_(layer.bias)

    def forward(self, x: Tensor) -> Tensor:
        """Return the outputs ``(..., out)`` in float32."""
        *hidden, last = self.layers
        for layer in hidden:
            x = self._activation(functional.linear(x, layer.weight.to(x.dtype), layer.bias.to(x.dtype)))
        return functional.linear(x.float(), last.weight, last.bias)


class ActorCritic(nn.Module):
    """Normalisation, policy, value function and the logarithm of the policy's standard deviation."""

    def __init__(self, observation_size: int, action_size: int, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        actor = (observation_size, *config.actor_sizes, action_size)
        critic = (observation_size, *config.critic_sizes, 1)
        self.normalizer = RunningNormalizer(observation_size, config.normalization_memory)
        self.actor = Mlp(actor, config.activation, config.actor_gain)
        self.critic = Mlp(critic, config.activation, config.critic_gain)
        self.log_std = nn.Parameter(torch.zeros(action_size), requires_grad=False)

    def act(self, observation: Tensor) -> Tensor:
        """Return the policy's mean ``(..., A)`` for raw observations ``(..., O)``, in float32."""
        return self.actor(self.normalizer(observation))

    def value(self, normalized: Tensor) -> Tensor:
        """Return V ``(...)`` of normalised observations ``(..., O)``."""
        return self.critic(normalized).squeeze(-1)


def export_weights(network: ActorCritic) -> PolicyWeights:
    """Return the policy's mean as the file and the executor have it; noise and critic stay behind."""
    return PolicyWeights(
        layers=tuple((_numpy(layer.weight), _numpy(layer.bias)) for layer in network.actor.layers),
        mean=_numpy(network.normalizer.mean),
        std=_numpy(network.normalizer.std),
    )


def _numpy(tensor: Tensor) -> np.ndarray:
    return tensor.detach().float().cpu().numpy().copy()
