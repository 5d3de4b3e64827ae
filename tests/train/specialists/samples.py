"""Small recipes and networks for tests of specialists."""

from __future__ import annotations

import torch

from unicon.train.learning.networks import ActorCritic
from unicon.train.runs.recipe import Recipe, read_recipe

SMALL = (
    "environment.num_envs=32",
    "environment.threads=1",
    "network.actor_sizes=[16]",
    "network.critic_sizes=[16]",
    "ppo.minibatch=64",
    "learner.threads=1",
    "learner.precision=fp32",
    "learner.steps=8",
    "run.tensorboard=false",
    "run.minutes=0.012",
    # no clip is easy so
    "environment.reward.threshold=0.95",
    "run.evaluate_clips=0",
    "specialists.jobs=1",
    "specialists.max_clips=2",
    "specialists.min_clips=1",
    "specialists.noisy_starts=2",
    "specialists.check_seconds=0.1",
    "specialists.single_minutes=0.0015",
    "specialists.finetuning_share=0.05",
    "specialists.student.actor_sizes=[64]",
    "specialists.student.critic_sizes=[16]",
    "specialists.distillation.minibatch=256",
    "specialists.distillation.replay_mb=16",
)


def small_recipe(*changes: str) -> Recipe:
    return read_recipe("specialists", (*SMALL, *changes))


def random_network(seed: int, recipe: Recipe, gain: float = 0.3) -> ActorCritic:
    """A policy whose actions are far from nothing."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        network = ActorCritic(403, 35, recipe.network)
        for layer in (network.actor.layers[-1], network.critic.layers[-1]):
            torch.nn.init.orthogonal_(layer.weight, gain)
    return network
