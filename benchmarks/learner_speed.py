"""How fast a recipe learns, and how much of the processor's arithmetic its learner uses.

The operations are those of the products alone: for a layer of a inputs and b outputs 2 a b a sample forward,
2 a b for the gradient of its weights, and as many for that of its inputs, except in the first layer.
"""

from __future__ import annotations

import time
from dataclasses import replace

import torch

from unicon.train.environment.dataset import Dataset
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.compute import choose_dtype
from unicon.train.learning.learner import Learner
from unicon.train.runs.recipe import Recipe

MATRIX = 1024
"""Side of the square matrices of the bare product."""
PRODUCTS = 20


class OurTraining:
    """A training by our learner under way, on the CPU."""

    def __init__(self, dataset: Dataset, recipe: Recipe) -> None:
        learner = replace(recipe.learner, device="cpu", threads=1)
        config = replace(recipe.environment, threads=1)
        self._recipe = replace(recipe, learner=learner, environment=config)
        self._learner = Learner(TrackingEnvironment(dataset, config), self._recipe)

    def time_iteration(self) -> float:
        """Return samples a second of one iteration: collecting and learning."""
        began = time.perf_counter()
        self._learner.iterate(progress=0.0)
        return self._learner.samples_an_iteration / (time.perf_counter() - began)

    def time_update(self) -> float:
        """Return operations a second [1e9] of an update with the samples of the last iteration."""
        batch = self._learner.rollout.batch()
        began = time.perf_counter()
        report = self._learner.ppo.update(batch)
        seconds = time.perf_counter() - began
        minibatch = min(self._recipe.ppo.minibatch, len(batch.returns))
        samples = report.epochs * (len(batch.returns) // minibatch) * minibatch
        return 1e-9 * samples * self.operations_a_sample() / seconds

    def operations_a_sample(self) -> int:
        """Return the operations of forward and backward through both networks."""
        network = self._learner.network
        return sum(
            layer.weight.numel() * (4 if index == 0 else 6)
            for mlp in (network.actor, network.critic)
            for index, layer in enumerate(mlp.layers)
        )


def time_matmul(recipe: Recipe) -> float:
    """Return operations a second [1e9] of bare square products in the type of the hidden layers."""
    dtype = choose_dtype(recipe.learner.precision, torch.device("cpu"))
    a, b = torch.randn(2, MATRIX, MATRIX).to(dtype)
    out = torch.empty_like(a)
    torch.set_num_threads(1)
    torch.mm(a, b, out=out)
    began = time.perf_counter()
    for _ in range(PRODUCTS):
        torch.mm(a, b, out=out)
    return 1e-9 * PRODUCTS * 2 * MATRIX**3 / (time.perf_counter() - began)
