"""Tests for observation_views.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.small_library import make_dataset
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.observation_views import ViewedEnvironment, as_seen, target_of, with_clip
from unicon.train.environment.tracking_environment import TrackingEnvironment

N = 12


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    return make_dataset(tmp_path_factory.mktemp("library"))


def make(dataset, observation: str, **changes) -> TrackingEnvironment:
    settings = {"simulator": "mujoco", "num_envs": N, "threads": 1, "mirror_share": 0.0, **changes}
    return TrackingEnvironment(dataset, EnvironmentConfig(observation=observation, **settings))


def actions(seed: int) -> np.ndarray:
    return 0.2 * np.random.default_rng(seed).standard_normal((N, 35)).astype(np.float32)


def test_phase_and_clip_stand_behind_the_avatar_s_own_state():
    seen = np.arange(2 * 403, dtype=np.float32).reshape(2, 403)
    clips, phases = np.array([2, 0]), np.array([0.25, 1.0])
    shown = with_clip(seen, "phase-onehot", clips, 3, phases)
    assert shown.shape == (2, 197 + 1 + 3) and shown.dtype == np.float32
    assert np.array_equal(shown[:, :197], seen[:, :197])
    assert shown[:, 197:].tolist() == [[0.25, 0, 0, 1], [1, 1, 0, 0]]
    number = with_clip(seen, "phase-number", clips, 4, phases)
    assert number[:, 197:].tolist() == [[0.25, 0.5], [1, 0]]


def test_the_target_is_the_second_part_of_what_is_seen():
    assert target_of(np.arange(403)).tolist() == list(range(197, 394))


@pytest.mark.parametrize(
    ("observation", "size"), [("targets-only", 197), ("phase-onehot", 197 + 1 + 3), ("phase-number", 197 + 2)]
)
def test_the_sizes_are_as_announced_and_everything_else_is_the_environment_s(dataset, observation, size):
    plain, viewed = make(dataset, "tau-1"), as_seen(make(dataset, observation))
    assert isinstance(viewed, ViewedEnvironment)
    assert viewed.observation_size == size
    assert (viewed.num_envs, viewed.action_size, viewed.dataset) == (N, 35, dataset)
    first = plain.reset()
    assert viewed.reset().shape == (N, size) and first.shape == (N, 403)
    for seed in range(10):
        expected, step = plain.step(actions(seed)), viewed.step(actions(seed))
        assert step.observation.shape == step.final_observation.shape == (N, size)
        assert np.array_equal(step.reward, expected.reward)
        assert np.array_equal(step.terminated, expected.terminated)


def test_an_environment_with_nothing_to_hide_stays_as_it_is(dataset):
    environment = make(dataset, "tau-2")
    assert as_seen(environment) is environment


def test_the_open_loop_view_does_not_depend_on_the_avatar(dataset):
    one, two = (as_seen(make(dataset, "targets-only", constraint=False, episode_s=60.0)) for _ in range(2))
    assert np.array_equal(one.reset(), two.reset())
    a, b = one.step(actions(0)), two.step(actions(1))
    assert not np.allclose(a.reward, b.reward, atol=1e-4)
    assert np.array_equal(a.final_observation, b.final_observation)


def test_the_phase_is_the_share_of_the_clip_that_is_over_before_and_after_an_end(dataset):
    inner = make(dataset, "phase-onehot", control_hz=30, episode_s=2 / 30, constraint=False)
    environment = as_seen(inner)
    environment.reset()
    environment.step(actions(0))
    clips, frames = inner.clips.copy(), inner.frames + 2
    step = environment.step(actions(1))
    assert step.truncated.all()
    lengths = dataset.lengths
    assert np.allclose(step.final_observation[:, 197], frames / (lengths[clips] - 1))
    assert np.array_equal(step.final_observation[:, 198:].argmax(axis=1), clips)
    assert np.allclose(step.observation[:, 197], inner.frames / (lengths[inner.clips] - 1))
    assert np.array_equal(step.observation[:, 198:], np.eye(3)[inner.clips])


def test_a_restored_environment_goes_on_to_the_bit(dataset):
    one, two = (as_seen(make(dataset, "phase-number")) for _ in range(2))
    one.reset()
    one.step(actions(0))
    two.reset()
    two.restore(one.state())
    for seed in range(5):
        assert np.array_equal(one.step(actions(seed)).observation, two.step(actions(seed)).observation)
