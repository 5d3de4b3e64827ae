import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon.reward import RewardTerms
from unicon.train.environment.vector_environment import EnvironmentStep
from unicon.train.learning.networks import ActorCritic, NetworkConfig
from unicon.train.learning.rollout import Rollout, generalized_advantages


def _column(*values):
    return torch.tensor(values)[:, None]


def test_advantages_are_those_of_a_hand_calculation():
    # gamma = 0.5, lambda = 0.5, one environment, an episode that ends with the second step (terminated)
    result = generalized_advantages(
        rewards=_column(1.0, 2.0, 4.0),
        values=_column(1.0, 3.0, 2.0),
        next_values=_column(3.0, 0.0, 8.0),
        dones=_column(False, True, False),
        gamma=0.5,
        lambda_=0.5,
    )
    # delta_0 = 1 + 1.5 - 1 = 1.5,   delta_1 = 2 + 0 - 3 = -1,   delta_2 = 4 + 4 - 2 = 6
    # A_2 = 6,   A_1 = -1 + 0 (cut off),   A_0 = 1.5 + 0.25 * -1 = 1.25
    assert result.advantages.flatten().tolist() == [1.25, -1.0, 6.0]
    assert result.returns.flatten().tolist() == [2.25, 2.0, 8.0]


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 8), st.floats(0.1, 0.99), st.integers(0, 2**31))
def test_with_lambda_1_the_return_is_the_discounted_sum_of_the_rewards(steps, gamma, seed):
    rng = np.random.default_rng(seed)
    rewards, values = rng.random((steps, 1)), rng.random((steps + 1, 1))
    result = generalized_advantages(
        *(torch.from_numpy(x) for x in (rewards, values[:-1], values[1:])),
        torch.zeros(steps, 1, dtype=torch.bool),
        gamma,
        1.0,
    )
    expected = sum(gamma**t * rewards[t, 0] for t in range(steps)) + gamma**steps * values[-1, 0]
    assert result.returns[0].item() == pytest.approx(expected)


def _filled_rollout(terminated, truncated, final):
    """Two steps of one environment; the network's value of an observation x is x."""
    network = ActorCritic(1, 1, NetworkConfig((), ()))
    network.critic.layers[0].weight.data.fill_(1.0)
    rollout = Rollout(2, 1, 1, 1, torch.float32, torch.device("cpu"))
    rollout.observations.copy_(torch.tensor([1.0, 2.0, 3.0])[:, None, None])
    rollout.begin()
    one = np.ones(1, np.float32)
    for t in range(2):
        step = EnvironmentStep(
            observation=np.zeros((1, 1), np.float32),
            reward=one,
            terminated=np.array([terminated and t == 0]),
            truncated=np.array([truncated and t == 0]),
            final_observation=np.array([[final]], np.float32),
            terms=RewardTerms(*[one] * 5),
        )
        rollout.record(t, step, network)
    rollout.compute_returns(network, gamma=0.5, lambda_=0.0, reward_scale=1.0)
    return rollout.returns.flatten().tolist()


def test_the_value_of_the_next_observation_follows_within_an_episode():
    assert _filled_rollout(False, False, 4.0) == [1.0 + 0.5 * 2.0, 1.0 + 0.5 * 3.0]


def test_nothing_follows_where_an_episode_terminated():
    assert _filled_rollout(True, False, 4.0) == [1.0, 1.0 + 0.5 * 3.0]


def test_the_value_of_the_last_observation_follows_where_an_episode_was_truncated():
    assert _filled_rollout(False, True, 4.0) == [1.0 + 0.5 * 4.0, 1.0 + 0.5 * 3.0]


def test_both_at_once_count_as_terminated():
    assert _filled_rollout(True, True, 4.0) == [1.0, 1.0 + 0.5 * 3.0]


def test_rows_of_a_batch_belong_together():
    rollout = Rollout(3, 4, 2, 1, torch.float32, torch.device("cpu"))
    for tensor in (rollout.rewards, rollout.returns, rollout.log_probs):
        tensor.copy_(torch.arange(12.0).view(3, 4))
    rollout.actions.copy_(torch.arange(12.0).view(3, 4, 1))
    rollout.observations[:-1] = torch.arange(12.0).view(3, 4, 1)
    rows = rollout.batch().rows(torch.tensor([7, 2]))
    assert rows.returns.tolist() == rows.log_probs.tolist() == rows.actions[:, 0].tolist() == [7.0, 2.0]
    assert rows.observations[:, 1].tolist() == [7.0, 2.0]
