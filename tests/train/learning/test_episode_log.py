import numpy as np
import pytest

from unicon.reward import RewardTerms
from unicon.train.environment.vector_environment import EnvironmentStep
from unicon.train.learning.episode_log import EpisodeLog


def _step(terminated, truncated, reward=0.5):
    rewards = np.full(3, reward, np.float32)
    empty = np.zeros((3, 1), np.float32)
    terms = RewardTerms(*(rewards * factor for factor in (1.0, 0.5, 0.4, 0.3, 0.2)))
    return EnvironmentStep(empty, rewards, np.array(terminated), np.array(truncated), empty, terms)


def test_lengths_and_survival_are_those_of_the_episodes_that_ended():
    log = EpisodeLog(3)
    log.add(_step([False, False, True], [False, False, False]))  # one breaks the constraint after 1 step
    log.add(_step([False, False, False], [True, False, False]))  # one comes to its end after 2
    log.add(_step([False, False, False], [False, False, True]))  # and another 2 after its first ended
    summary = log.summary()
    assert summary.length == pytest.approx((1 + 2 + 2) / 3)
    assert summary.survival == pytest.approx(2 / 3)
    assert log.lengths.tolist() == [1, 3, 0]


def test_rewards_and_terms_are_means_over_the_iteration():
    log = EpisodeLog(3)
    none = [False] * 3
    log.add(_step(none, none, reward=0.2))
    log.add(_step(none, none, reward=0.6))
    assert log.summary().reward == pytest.approx(0.4)
    assert log.summary().terms.joint_velocity == pytest.approx(0.08)
    log.begin()
    log.add(_step(none, none, reward=1.0))
    assert log.summary().reward == pytest.approx(1.0)


def test_where_no_episode_ended_the_last_figures_stand():
    log = EpisodeLog(3)
    log.add(_step([True] * 3, [False] * 3))
    log.summary()
    log.begin()
    log.add(_step([False] * 3, [False] * 3))
    assert log.summary().length == 1.0
    assert log.summary().survival == 0.0
