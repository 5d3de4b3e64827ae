from dataclasses import replace

import numpy as np
import pytest

from tests.train.small_library import make_dataset
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.policy_file import read_policy
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.learner import Learner
from unicon.train.runs.checkpoint import write_checkpoint
from unicon.train.runs.recipe import read_recipe
from unicon.train.runs.run_folder import open_run
from unicon.train.runs.trained_policy import card_of, make_evaluation, read_trained
from unicon.train.scoring.policy_export import export_policy

SMALL = (
    "environment.simulator=mujoco",
    "environment.num_envs=4",
    "environment.threads=1",
    "environment.stride=2",
    "network.actor_sizes=[16]",
    "network.critic_sizes=[16]",
    "learner.threads=1",
)


@pytest.fixture
def learner(tmp_path):
    recipe = read_recipe("laptop", SMALL)
    return Learner(TrackingEnvironment(make_dataset(tmp_path / "library"), recipe.environment), recipe)


def test_a_run_becomes_a_policy_that_acts_as_in_training(learner, tmp_path):
    learner.iterate(0.0)
    open_run(tmp_path / "run", learner.recipe, resume=False)
    checkpoint = write_checkpoint(tmp_path / "run", learner, seconds=36.0, keep=1)
    card, weights = read_trained(tmp_path / "run", "mine")
    assert read_trained(checkpoint, "mine")[0] == card
    assert (card.tau, card.future, card.action) == (1, (2,), "pd")
    assert card.training.endswith("0.0 M samples in 0.01 h on 1 process(es)")
    export_policy(tmp_path / "mine", replace(card, training_data="own clips"), weights)
    card, weights = read_policy(tmp_path / "mine")
    outputs = weights.evaluate(learner.observation[0], card.activation)
    seen = learner.rollout.rewards.new_tensor(learner.observation[0])
    assert np.allclose(outputs, learner.network.act(seen).detach().numpy(), atol=1e-5)
    assert len(outputs) == len(HUMANOID.joint_names)


def test_the_policy_is_scored_on_some_of_the_clips(learner):
    learner.start()
    recipe = replace(learner.recipe, run=replace(learner.recipe.run, evaluate_clips=2))
    scores = make_evaluation(learner.environment.dataset, recipe)(learner)
    assert 0.0 < scores["survival"] <= 1.0
    assert all(np.isfinite(value) for value in scores.values())


def test_without_clips_to_score_nothing_is_scored(learner):
    recipe = replace(learner.recipe, run=replace(learner.recipe.run, evaluate_clips=0))
    assert make_evaluation(learner.environment.dataset, recipe) is None


def test_the_target_pose_itself_is_no_policy():
    recipe = read_recipe("laptop", ["environment.action=kinematic"])
    with pytest.raises(UniconError, match="trains no policy"):
        card_of(recipe, "none")
