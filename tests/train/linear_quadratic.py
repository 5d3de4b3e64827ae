"""A task with a known optimum: many carts on a rail, each to be brought to rest at the origin.

s = (place, speed),   s' = A s + B a,   reward = -(s' Q s + R a^2)
"""

import json

import numpy as np
from scipy.linalg import solve_discrete_are

from unicon.reward import RewardTerms
from unicon.train.environment.vector_environment import EnvironmentStep
from unicon.train.learning.learner import Learner, LearnerConfig
from unicon.train.learning.networks import NetworkConfig
from unicon.train.learning.ppo import PPOConfig
from unicon.train.learning.variance_controller import VarianceConfig
from unicon.train.runs.recipe import Recipe
from unicon.train.runs.training_run import RunConfig

A = np.array([[1.0, 0.3], [0.0, 0.9]])
B = np.array([[0.0], [0.5]])
Q = np.diag([1.0, 0.1])
R = np.array([[0.1]])
EPISODE = 20


class LinearQuadratic:
    """N carts; an episode is cut off after 20 steps, and ends when a cart runs far away."""

    observation_size, action_size = 2, 1

    def __init__(self, num_envs=256, seed=0, bad_at=None):
        self.num_envs = num_envs
        self.rng = np.random.default_rng(seed)
        self.states = np.zeros((num_envs, 2))
        self.steps = np.zeros(num_envs, np.int64)
        self.count, self.bad_at = 0, bad_at

    def reset(self):
        self.states = self.rng.standard_normal((self.num_envs, 2))
        self.steps = self.rng.integers(0, EPISODE, self.num_envs)
        return self.states.astype(np.float32)

    def step(self, actions):
        self.count += 1
        actions = actions.astype(np.float64)
        cost = np.einsum("ni,ij,nj->n", self.states, Q, self.states) + R[0, 0] * actions[:, 0] ** 2
        if self.count == self.bad_at:
            cost[0] = np.nan
        self.states = self.states @ A.T + actions @ B.T
        self.steps += 1
        final = self.states.astype(np.float32)
        terminated = np.abs(self.states).max(axis=1) > 20.0
        truncated = self.steps >= EPISODE
        ended = terminated | truncated
        self.states[ended] = self.rng.standard_normal((int(ended.sum()), 2))
        self.steps[ended] = 0
        reward = (-cost).astype(np.float32)
        terms = RewardTerms(*[np.exp(reward)] * 5)
        return EnvironmentStep(self.states.astype(np.float32), reward, terminated, truncated, final, terms)

    def state(self):
        random = np.frombuffer(json.dumps(self.rng.bit_generator.state).encode(), np.uint8)
        return {
            "states": self.states,
            "steps": self.steps,
            "count": np.array(self.count),
            "random": random,
        }

    def restore(self, state):
        self.states, self.steps = state["states"].copy(), state["steps"].copy()
        self.count = int(state["count"])
        self.rng.bit_generator.state = json.loads(state["random"].tobytes())


def recipe(**changes):
    """Return settings with which the carts are learned in seconds."""
    settings = {
        "network": NetworkConfig((32, 32), (32, 32), activation="tanh"),
        "variance": VarianceConfig(points=((0.0, 0.5), (0.7, 0.1), (1.0, 0.1))),
        "ppo": PPOConfig(
            gamma=0.9, minibatch=512, kl_target=0.02, learning_rate=1e-3, learning_rate_max=3e-3
        ),
        "learner": LearnerConfig(threads=1, precision="fp32", device="cpu"),
        "run": RunConfig(million_samples=0.0041 * 10, tensorboard=False),
    }
    return Recipe(**{**settings, **changes})


def make_learner(environment=None, world=None, **changes):
    """Return a learner of the carts."""
    return Learner(environment or LinearQuadratic(), recipe(**changes), world)


def riccati(gamma):
    """Return P of the optimal cost s' P s, with the discount within A and B."""
    return solve_discrete_are(np.sqrt(gamma) * A, np.sqrt(gamma) * B, Q, R)


def discounted_cost(act, states, gamma, steps=150):
    """Return the mean discounted cost of a policy from states ``(n, 2)``."""
    total, discount = np.zeros(len(states)), 1.0
    for _ in range(steps):
        actions = act(states)
        total += discount * (np.einsum("ni,ij,nj->n", states, Q, states) + R[0, 0] * actions[:, 0] ** 2)
        states = states @ A.T + actions @ B.T
        discount *= gamma
    return total.mean()
