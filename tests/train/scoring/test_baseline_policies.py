"""Tests for baseline_policies.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import swaying_clip
from tests.train.policy_samples import make_card
from tests.train.small_library import make_library
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.observation import observe, policy_input
from unicon.policy import NetworkPolicy, PolicyContext
from unicon.policy_file import PolicyWeights
from unicon.train.environment.dataset import choose_clips
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.observation_views import as_seen, view_size
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.runs.recipe import read_recipe
from unicon.train.scoring.baseline_policies import ClipPolicy, OpenLoopPolicy, score_network
from unicon.train.scoring.evaluation import evaluate
from unicon.train.scoring.evaluation_clips import from_library


def weights_of(size: int) -> PolicyWeights:
    rng = np.random.default_rng(0)
    sizes = (size, 16, len(HUMANOID.joint_names))
    layers = tuple(
        ((0.3 / np.sqrt(a) * rng.standard_normal((b, a))).astype(np.float32), np.zeros(b, np.float32))
        for a, b in zip(sizes[:-1], sizes[1:], strict=True)
    )
    return PolicyWeights(layers, np.zeros(size, np.float32), np.ones(size, np.float32))


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return make_library(tmp_path_factory.mktemp("library"))


def test_the_open_loop_policy_sees_the_target_alone():
    frames = swaying_clip(20).frames
    policy = OpenLoopPolicy(make_card(), weights_of(197))
    seen = policy.observe(PolicyContext(frames[3:4], frames[5:6][None]))
    assert np.allclose(seen[0], observe(frames[5], forward_kinematics(frames[5])))
    other = policy.observe(PolicyContext(frames[9:10], frames[5:6][None]))
    assert np.array_equal(seen, other)


def test_the_clip_policy_knows_its_clip_and_counts_its_ticks():
    frames = swaying_clip(20).frames
    lengths = np.array([30, 21, 40])
    policy = ClipPolicy(make_card(), weights_of(201), "phase-onehot", 1, lengths)
    context = PolicyContext(frames[3:4], frames[4:5][None])
    first, second = policy.observe(context), policy.observe(context)
    own = policy_input(context.actual, context.targets)[0, :197]
    assert np.allclose(first[0, :197], own, atol=1e-5)
    assert first[0, 197:].tolist() == [0, 0, 1, 0]
    assert second[0, 197:] == pytest.approx([1 / 20, 0, 1, 0])


@pytest.mark.parametrize("view", ["phase-onehot", "phase-number"])
def test_in_the_evaluation_it_sees_what_it_saw_in_training(library, view):
    dataset = choose_clips(library)
    config = EnvironmentConfig(
        simulator="mujoco", num_envs=1, observation=view, control_hz=60, mirror_share=0.0, rsis_share=0.0
    )
    environment = as_seen(TrackingEnvironment(dataset, config))
    trained = environment.reset()
    clip, frame = int(environment.environment.clips[0]), int(environment.environment.frames[0])
    policy = ClipPolicy(make_card(), weights_of(trained.shape[1]), view, clip, dataset.lengths)
    frames = library.get(dataset.infos[clip].name).frames
    for tick in range(frame + 1):
        seen = policy.observe(PolicyContext(frames[tick : tick + 1], frames[tick : tick + 1][None]))
    assert np.allclose(seen[0, 197:], trained[0, 197:], atol=1e-6)


@pytest.mark.parametrize("view", ["phase-onehot", "phase-number"])
def test_a_policy_that_knows_clips_by_their_place_is_not_scored_on_others(library, view):
    recipe = read_recipe("pd", [f"environment.observation={view}"])
    learned = choose_clips(library, recipe.dataset)
    weights = weights_of(view_size(view, 3))
    done = score_network(recipe, weights, learned, from_library(library, "All", "train"), "x", 1)
    assert done is not None and [info.name for info in done.infos] == [i.name for i in learned.infos]
    assert all(0.0 <= score.survival <= 1.0 for score in done.scores)
    assert score_network(recipe, weights, learned, from_library(library, "All", "test"), "x", 1) is None


def test_a_usual_policy_is_scored_as_by_the_evaluator(library):
    recipe = read_recipe("pd")
    source = from_library(library, "All", "test")
    learned = choose_clips(library, recipe.dataset)
    done = score_network(recipe, weights_of(403), learned, source, "x", 1)
    card = make_card(action="pd", future=(1,))
    assert done is not None
    expected = evaluate(NetworkPolicy(card, weights_of(403)), source, jobs=1)
    assert repr(done.scores) == repr(expected.scores)
