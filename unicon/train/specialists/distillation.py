"""Distillation: one student learns from all specialists what they would do where it comes to itself.

DAgger (Ross, Gordon and Bagnell 2011). In the batch simulator, each episode is acted by the clip's teacher
or by the student; the teacher's share falls from 1 to 0. Noise on the actions leads both off the path. Each
state seen is kept with what the teacher would do there, and the student learns from all of them alike:

    L = mean 1/2 |(mean(s) - teacher's mean(s)) / noise|^2 + mean (V(s) - teacher's V(s))^2

The first part is KL(teacher | student) for policies with that noise; the two parts share no weights.
"""

from __future__ import annotations

import math
import time

import numpy as np
import torch
from torch import Tensor

from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.compute import choose_dtype
from unicon.train.learning.learner import IterationReport, Learner
from unicon.train.learning.ppo import NotFiniteError, UpdateReport
from unicon.train.runs.recipe import Recipe
from unicon.train.specialists.config import DistillationConfig
from unicon.train.specialists.replay import Lesson, Replay
from unicon.train.specialists.teachers import Teachers


class Distiller(Learner):
    """A learner that has teachers in place of PPO; a ``TrainingRun`` runs, saves and logs it as any other.

    In its reports ``update.kl`` is the divergence from the teachers, ``update.surrogate`` the mean squared
    difference of an action from the teacher's, and ``update.clipped`` the share of episodes that teachers
    act.
    """

    environment: TrackingEnvironment

    def __init__(
        self,
        environment: TrackingEnvironment,
        recipe: Recipe,
        teachers: Teachers,
        config: DistillationConfig,
    ) -> None:
        """Begin with new weights and an empty replay.

        Args:
            environment: one that plays the clips of all teachers.
            recipe: with the student's networks, rates and budget.
            teachers: who know what to do.
            config: how to learn from them.
        """
        super().__init__(environment, recipe)
        self.teachers, self.config = teachers, config
        sizes = environment.observation_size, environment.action_size
        self.replay = Replay(*sizes, config.replay_mb, self.device)
        self._dtype = choose_dtype(recipe.learner.precision, self.device)
        self._taught = torch.zeros(environment.num_envs, 1, dtype=torch.bool, device=self.device)

    def start(self) -> None:
        """Begin the first episodes."""
        super().start()
        self._draw_actors(np.ones(self.environment.num_envs, np.bool_), 1.0)

    def iterate(self, progress: float) -> IterationReport:
        """Act for T steps, and learn after each.

        Args:
            progress: share of the training that is done.

        Raises:
            NotFiniteError: when an observation or a gradient is not finite.
        """
        if self.observation is None:
            self.start()
        began, learned_s, losses = time.perf_counter(), 0.0, []
        self.episodes.begin()
        rate, share = self.learning_rate(progress), self.teacher_share(progress)
        for group in self.ppo.optimizer.param_groups:
            group["lr"] = rate
        for _ in range(self.recipe.learner.steps):
            self._act(share)
            acted = time.perf_counter()
            losses += [self._learn() for _ in range(self.config.updates_a_step)]
            learned_s += time.perf_counter() - acted
        self.ppo.learning_rate = rate
        self.network.normalizer.commit(self.network.normalizer.pending())
        self.iteration += 1
        self.samples += self.samples_an_iteration
        error, value, norm = torch.stack(losses).mean(dim=0).tolist()
        return self._report(error, value, norm, share, time.perf_counter() - began - learned_s, learned_s)

    def learning_rate(self, progress: float) -> float:
        """Return Adam's rate: half a cosine from the first to the last."""
        first, last = self.config.learning_rate, self.config.learning_rate_end
        return last + 0.5 * (first - last) * (1.0 + math.cos(math.pi * progress))

    def teacher_share(self, progress: float) -> float:
        """Return the share of the episodes that teachers act."""
        return max(0.0, 1.0 - progress / self.config.teacher_until) if self.config.teacher_until else 0.0

    @torch.no_grad()
    def _act(self, share: float) -> None:
        """Make a step in all environments, and keep what was seen with the teachers' advice."""
        assert self.observation is not None
        seen, network = self._to_device(self.observation), self.network
        if not bool(torch.isfinite(seen).all()):
            raise NotFiniteError("an observation")
        advice = self.teachers.advise(seen, self.environment.clips)
        self.replay.add(Lesson(seen, *advice))
        z = torch.empty_like(seen, dtype=self._dtype)
        network.normalizer.take_in(seen, out=z)
        actions = torch.where(self._taught, advice.actions, network.actor(z))
        self._noise.normal_(generator=self.generator)
        step = self.environment.step(actions.add_(self._noise, alpha=self.config.noise).cpu().numpy())
        self.episodes.add(step)
        self._draw_actors(step.terminated | step.truncated, share)
        self.observation = step.observation

    def _learn(self) -> Tensor:
        """Make a gradient step; return error of the actions, loss of the values, length of the gradient."""
        lesson = self.replay.draw(self.config.minibatch, self.generator)
        z = self.network.normalizer(lesson.observations).to(self._dtype)
        difference = self.network.actor(z) - lesson.actions
        value = (self.network.value(z) - lesson.values).square().mean()
        loss = 0.5 * (difference / self.config.noise).square().sum(-1).mean() + value
        self.ppo.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        gradients = [p.grad for p in self.ppo.parameters if p.grad is not None]
        norm = torch.nn.utils.get_total_norm(gradients)
        if not math.isfinite(float(norm)):
            raise NotFiniteError("the gradient of the loss")
        self.ppo.optimizer.step()
        return torch.stack([difference.detach().square().mean(), value.detach(), norm])

    def _draw_actors(self, begun: np.ndarray, share: float) -> None:
        """Draw who acts in the episodes that begin ``(N,)``."""
        draws = torch.rand(len(begun), 1, generator=self.generator, device=self.device)
        rows = torch.from_numpy(begun).to(self.device)[:, None]
        self._taught = torch.where(rows, draws < share, self._taught)

    def _report(
        self, error: float, value: float, norm: float, share: float, collect_s: float, update_s: float
    ) -> IterationReport:
        kl = 0.5 * error * self.environment.action_size / self.config.noise**2
        update = UpdateReport(kl, error, value, share, norm, self.ppo.learning_rate, 0.0, 1)
        return IterationReport(
            iteration=self.iteration,
            samples=self.samples,
            new_samples=self.samples_an_iteration,
            episodes=self.episodes.summary(),
            std=self.config.noise,
            explained=0.0,
            update=update,
            collect_s=collect_s,
            update_s=update_s,
        )
