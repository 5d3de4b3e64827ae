"""From a training to a policy: its card, its weights, and its scores while it is being trained."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.observation import OBSERVATION_ID
from unicon.policy import NetworkPolicy
from unicon.policy_file import CONTROL_HZ, PolicyCard, PolicyWeights
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.observation_variants import parse_variant
from unicon.train.learning.compute import share_of_processors
from unicon.train.learning.learner import Learner
from unicon.train.learning.networks import ActorCritic, export_weights
from unicon.train.runs.checkpoint import CheckpointNumbers, read_networks
from unicon.train.runs.recipe import Recipe, read_recipe
from unicon.train.runs.run_folder import CONFIG_FILE, run_of
from unicon.train.runs.training_run import Evaluate
from unicon.train.scoring.evaluation import evaluate, summarise
from unicon.train.scoring.evaluation_clips import ClipSource
from unicon.train.specialists.plan import read_plan


def card_of(recipe: Recipe, name: str) -> PolicyCard:
    """Return the card of a policy that a recipe trains.

    Raises:
        UniconError: when the recipe's actions are those of no policy.
    """
    config = recipe.environment
    if config.action == "kinematic":
        raise UniconError("a run with environment.action=kinematic trains no policy: its actions do nothing")
    variant = parse_variant(config.observation, config.stride)
    return PolicyCard(
        name=name,
        description=recipe.description,
        humanoid_id=HUMANOID.id,
        observation_id=OBSERVATION_ID,
        tau=len(variant.future),
        control_hz=CONTROL_HZ,
        action=config.action,
        activation=recipe.network.activation,
        training_data="",
        future=variant.future,
        past=variant.past,
    )


def network_of(recipe: Recipe) -> ActorCritic:
    """Return networks of the sizes that a recipe asks for, with new weights."""
    size = parse_variant(recipe.environment.observation, recipe.environment.stride).size
    return ActorCritic(size, len(HUMANOID.joint_names), recipe.network)


def read_trained(path: Path, name: str) -> tuple[PolicyCard, PolicyWeights]:
    """Return the policy of a run or of a checkpoint; of a training by specialists, the newest student.

    Raises:
        InputFileError: when the run's settings or its checkpoint cannot be read.
        UniconError: when it trains no policy, or one for comparisons only.
    """
    folder = run_of(path)
    recipe = read_recipe(folder / CONFIG_FILE)
    if recipe.specialists is not None:
        student = read_plan(folder).last_run
        if student is None:
            raise UniconError(f"{folder}: has no student yet; go on with its training with --resume")
        return read_trained(student, name)
    if not _sees_whole_input(recipe):
        raise UniconError(
            f"{folder}: saw environment.observation={recipe.environment.observation}, of which no "
            "policy file can be made; it is for `unicon compare`"
        )
    card = card_of(recipe, name)
    network = network_of(recipe)
    numbers = read_networks(path, network)
    card = PolicyCard(**{**vars(card), "training": _training(recipe, numbers)})
    return card, export_weights(network)


def make_evaluation(dataset: Dataset, recipe: Recipe) -> Evaluate | None:
    """Return what scores the policy in MuJoCo, as `unicon evaluate` does, on some of the clips it learns.

    None where the recipe asks for no evaluation or its actions are those of no policy.
    """
    count = recipe.run.evaluate_clips
    if not count or recipe.environment.action == "kinematic" or not _sees_whole_input(recipe):
        return None
    infos = dataset.infos
    chosen = np.unique(np.linspace(0, len(infos) - 1, min(count, len(infos))).round().astype(int))
    source = ClipSource("clips of the training", tuple(infos[i] for i in chosen), dataset.library.folder)
    card = card_of(recipe, "in training")

    def score(learner: Learner) -> Mapping[str, float]:
        policy = NetworkPolicy(card, export_weights(learner.network))
        figures = summarise(evaluate(policy, source, jobs=share_of_processors()))[0].figures
        return {name: value for name, value in figures.items() if np.isfinite(value)}

    return score


def _sees_whole_input(recipe: Recipe) -> bool:
    """Return whether the network sees s_t as policies do, not a baseline's view of it."""
    return parse_variant(recipe.environment.observation, recipe.environment.stride).view == "whole"


def _training(recipe: Recipe, numbers: CheckpointNumbers) -> str:
    """Return in words how it was trained."""
    config = recipe.environment
    return (
        f"{recipe.description}; {config.action} at {config.control_hz} Hz in {config.simulator}; "
        f"{numbers.samples / 1e6:.1f} M samples in {numbers.seconds / 3600:.2f} h "
        f"on {numbers.processes} process(es)"
    )
