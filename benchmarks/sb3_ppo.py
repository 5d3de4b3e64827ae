"""stable-baselines3's PPO on our environment in MuJoCo, with the sizes of one of our recipes.

It gets the network, the first noise, the number of environments, steps, epochs and the minibatch of the
recipe, on the CPU. It does not normalise observations, which costs ours some time and it none. At 30 Hz
control a sample is eight physics steps in both.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from gymnasium.spaces import Box
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnv

from unicon.train.environment.dataset import Dataset
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.environment.vector_environment import VectorEnvironment
from unicon.train.learning.networks import ACTIVATIONS
from unicon.train.runs.recipe import Recipe

MODULES = {"relu": torch.nn.ReLU, "elu": torch.nn.ELU, "silu": torch.nn.SiLU, "tanh": torch.nn.Tanh}
assert MODULES.keys() == ACTIVATIONS.keys()


class Sb3Environment(VecEnv):
    """Our contract under theirs."""

    def __init__(self, environment: VectorEnvironment) -> None:
        self._environment = environment
        seen = Box(-np.inf, np.inf, (environment.observation_size,), np.float32)
        acts = Box(-1.0, 1.0, (environment.action_size,), np.float32)
        super().__init__(environment.num_envs, seen, acts)

    def reset(self) -> np.ndarray:
        """Begin a new episode everywhere."""
        return self._environment.reset()

    def step_async(self, actions: np.ndarray) -> None:
        """Take in what is to be done."""
        self._actions = actions

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """Do it; an episode that ended is told of as stable-baselines3 wants it."""
        step = self._environment.step(self._actions)
        dones = step.terminated | step.truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for env in np.flatnonzero(dones):
            infos[env]["terminal_observation"] = step.final_observation[env]
            infos[env]["TimeLimit.truncated"] = bool(step.truncated[env])
        return step.observation, step.reward, dones, infos

    def close(self) -> None:
        """Do nothing: there is nothing to close."""

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return an attribute of the environments: only that there is nothing to draw."""
        return [getattr(self, attr_name, None)] * self.num_envs

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of all environments."""
        setattr(self, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> Sequence[Any]:
        """Call a method of all environments."""
        return [getattr(self, method_name)(*args, **kwargs)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Say that nothing is wrapped."""
        return [False] * self.num_envs


class Sb3Training:
    """A training by stable-baselines3 under way."""

    def __init__(self, dataset: Dataset, recipe: Recipe) -> None:
        config = replace(recipe.environment, simulator="mujoco", threads=1)
        environment = Sb3Environment(TrackingEnvironment(dataset, config))
        self._samples = recipe.learner.steps * config.num_envs
        policy = {
            "net_arch": {"pi": list(recipe.network.actor_sizes), "vf": list(recipe.network.critic_sizes)},
            "activation_fn": MODULES[recipe.network.activation],
            "log_std_init": math.log(recipe.variance.points[0][1]),
        }
        torch.set_num_threads(1)
        self._model = PPO(
            "MlpPolicy",
            environment,
            learning_rate=recipe.ppo.learning_rate,
            n_steps=recipe.learner.steps,
            batch_size=recipe.ppo.minibatch,
            n_epochs=recipe.ppo.epochs,
            gamma=recipe.ppo.gamma,
            gae_lambda=recipe.ppo.lambda_,
            clip_range=recipe.ppo.clip,
            policy_kwargs=policy,
            device="cpu",
            seed=0,
        )

    def time_iteration(self) -> float:
        """Return samples a second of one iteration: collecting and learning."""
        began = time.perf_counter()
        self._model.learn(self._samples, reset_num_timesteps=False)
        return self._samples / (time.perf_counter() - began)
