"""The learner: collect a rollout, compute the returns, update the policy; one call of ``iterate`` each.

It owns all that the next iteration depends on, so that it can be saved and go on to the bit.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import torch
from torch import Tensor

from unicon.errors import UniconError
from unicon.train.environment.vector_environment import VectorEnvironment
from unicon.train.learning.compute import choose_device, choose_dtype, use_threads
from unicon.train.learning.distributed import World
from unicon.train.learning.episode_log import EpisodeLog, EpisodeSummary
from unicon.train.learning.networks import ActorCritic
from unicon.train.learning.normalizer import moments_of
from unicon.train.learning.ppo import PPO, NotFiniteError, UpdateReport, gaussian_log_prob
from unicon.train.learning.rollout import Rollout
from unicon.train.learning.variance_controller import control_log_std, scheduled_log_std

if TYPE_CHECKING:
    from unicon.train.runs.recipe import Recipe


@dataclass(frozen=True)
class LearnerConfig:
    """Size of an iteration and where it is computed."""

    steps: int = 16
    """Control steps of every environment in an iteration."""
    seed: int = 0
    """Of the first weights, the noise and the order of the samples."""
    device: Literal["auto", "cpu", "cuda"] = "auto"
    """auto: a GPU where there is one."""
    threads: int = 0
    """Threads of torch; 0: this process's share of the processors."""
    precision: Literal["auto", "bf16", "fp32"] = "auto"
    """Of the hidden layers; auto: bf16 where the processor has it."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        if self.steps < 1 or self.threads < 0 or self.seed < 0:
            raise UniconError("learner: expected steps of 1 or more, threads and seed of 0 or more")


class IterationReport(NamedTuple):
    """What an iteration brought."""

    iteration: int
    samples: int
    """Of all processes, since the beginning."""
    new_samples: int
    """Of all processes, in this iteration."""
    episodes: EpisodeSummary
    """Of this process."""
    std: float
    """Mean deviation of the noise [shares of the largest torque]."""
    explained: float
    """Share of the variance of the returns that the value function explains."""
    update: UpdateReport
    collect_s: float
    update_s: float


class Learner:
    """PPO on a batch of environments."""

    def __init__(self, environment: VectorEnvironment, recipe: Recipe, world: World | None = None) -> None:
        """Begin with new weights, and the environments with new episodes."""
        self.environment, self.recipe, self.world = environment, recipe, world or World()
        config = recipe.learner
        self.iteration = self.samples = 0
        self.device = choose_device(config.device)
        use_threads(config.threads)
        sizes = environment.observation_size, environment.action_size
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(config.seed)
            self.network = ActorCritic(*sizes, recipe.network).to(self.device)
        self.generator = torch.Generator(self.device).manual_seed(config.seed * 1009 + self.world.rank)
        first = scheduled_log_std(recipe.variance, 0.0, 0, environment.action_size)
        self.network.log_std.data.copy_(torch.from_numpy(first))
        self.network.log_std.requires_grad_(recipe.variance.mode != "scheduled")
        self.ppo = PPO(self.network, recipe.ppo, self.world, self.generator)
        dtype = choose_dtype(config.precision, self.device)
        self.rollout = Rollout(config.steps, environment.num_envs, *sizes, dtype, self.device)
        self._noise = torch.empty(environment.num_envs, environment.action_size, device=self.device)
        self.episodes = EpisodeLog(environment.num_envs)
        self.observation: np.ndarray | None = None
        """What to act on next ``(N, O)``; None before the first episodes began."""

    @property
    def samples_an_iteration(self) -> int:
        """Samples of all processes in one iteration."""
        return self.recipe.learner.steps * self.environment.num_envs * self.world.size

    def start(self) -> None:
        """Begin the first episodes, and normalise by their first observations where nothing else is known."""
        self.observation = self.environment.reset()
        if self.network.normalizer.count == 0:
            first = moments_of(self._to_device(self.observation))
            self.network.normalizer.commit(self.world.merge_moments(first))
        self.world.copy_from_leader(self.network.state_dict().values())

    def iterate(self, progress: float) -> IterationReport:
        """Collect, compute the returns and update.

        Args:
            progress: share of the training that is done, for the schedule of the noise.

        Raises:
            NotFiniteError: when an observation, a reward or a gradient is not finite.
        """
        if self.observation is None:
            self.start()
        self._control_noise(progress)
        began = time.perf_counter()
        self.collect()
        collected = time.perf_counter()
        self.compute_returns()
        update = self.ppo.update(self.rollout.batch())
        self.network.normalizer.commit(self._pending)
        self.iteration += 1
        self.samples += self.samples_an_iteration
        return IterationReport(
            iteration=self.iteration,
            samples=self.samples,
            new_samples=self.samples_an_iteration,
            episodes=self.episodes.summary(),
            std=float(self.network.log_std.detach().exp().mean()),
            explained=self._explained(),
            update=update,
            collect_s=collected - began,
            update_s=time.perf_counter() - collected,
        )

    @torch.no_grad()
    def collect(self) -> None:
        """Act for T steps: a_t = mean(s_t) + std noise."""
        rollout, network = self.rollout, self.network
        rollout.begin()
        self.episodes.begin()
        std = network.log_std.exp()
        observation = self.observation
        assert observation is not None
        for t in range(rollout.steps):
            seen = rollout.observations[t]
            network.normalizer.take_in(self._to_device(observation), out=seen)
            means = rollout.means[t].copy_(network.actor(seen))
            self._noise.normal_(generator=self.generator)
            actions = torch.addcmul(means, self._noise, std, out=rollout.actions[t])
            rollout.log_probs[t] = gaussian_log_prob(actions, means, network.log_std)
            step = self.environment.step(actions.cpu().numpy())
            rollout.record(t, step, network)
            self.episodes.add(step)
            observation = step.observation
        rollout.observations[-1].copy_(network.normalizer(self._to_device(observation)))
        self.observation = observation

    def compute_returns(self) -> None:
        """Fill in the advantages, and look whether all that was collected is finite."""
        config = self.recipe.ppo
        scale = 1.0 - config.gamma if config.scale_rewards else 1.0
        self.rollout.compute_returns(self.network, config.gamma, config.lambda_, scale)
        self._pending = self.world.merge_moments(self.network.normalizer.pending())
        # one process that stops alone would leave the others waiting for it
        names = ("an observation", "a reward", "a value")
        tensors = self._pending.variance, self.rollout.rewards, self.rollout.returns
        bad = self.world.any([not bool(torch.isfinite(tensor.sum())) for tensor in tensors])
        if any(bad):
            raise NotFiniteError(names[bad.index(True)], self.rollout.batch())

    def _control_noise(self, progress: float) -> None:
        log_std = self.network.log_std.data.double().cpu().numpy()
        log_std = control_log_std(self.recipe.variance, log_std, progress, self.samples)
        self.network.log_std.data.copy_(torch.from_numpy(log_std))

    def _explained(self) -> float:
        """Return 1 - var(R - V) / var(R)."""
        unexplained = (self.rollout.returns - self.rollout.values).var(correction=0)
        return float(1.0 - unexplained / self.rollout.returns.var(correction=0).clamp(min=1e-12))

    def _to_device(self, array: np.ndarray) -> Tensor:
        return torch.from_numpy(np.ascontiguousarray(array, np.float32)).to(self.device)
