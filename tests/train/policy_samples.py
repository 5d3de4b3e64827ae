"""Small random policies."""

from __future__ import annotations

import dataclasses

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.observation import OBSERVATION_ID
from unicon.policy import NetworkPolicy
from unicon.policy_file import PolicyCard, PolicyWeights


def make_card(**changes) -> PolicyCard:
    card = PolicyCard(
        name="small",
        description="A random network.",
        humanoid_id=HUMANOID.id,
        observation_id=OBSERVATION_ID,
        tau=1,
        control_hz=60,
        action="torque",
        activation="relu",
        training_data="nothing",
    )
    return dataclasses.replace(card, **changes)


def make_weights(card: PolicyCard, hidden: tuple[int, ...] = (24, 16), scale: float = 0.3) -> PolicyWeights:
    rng = np.random.default_rng(0)
    sizes = (card.input_size, *hidden, len(HUMANOID.joint_names))
    layers = tuple(
        (
            scale / np.sqrt(a) * rng.standard_normal((b, a), dtype=np.float32),
            0.1 * scale * rng.standard_normal(b, dtype=np.float32),
        )
        for a, b in zip(sizes[:-1], sizes[1:], strict=True)
    )
    mean = 0.1 * rng.standard_normal(sizes[0], dtype=np.float32)
    std = np.exp(0.2 * rng.standard_normal(sizes[0], dtype=np.float32))
    return PolicyWeights(layers, mean, std)


def make_policy(hidden: tuple[int, ...] = (24, 16), scale: float = 0.3, **changes) -> NetworkPolicy:
    card = make_card(**changes)
    return NetworkPolicy(card, make_weights(card, hidden, scale))
