"""The recipe of each stage, made of that of the whole; every one is that of an ordinary run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from unicon.errors import UniconError
from unicon.train.environment.observation_variants import parse_variant
from unicon.train.runs.recipe import Recipe
from unicon.train.specialists.config import Points, SpecialistsConfig


def check_recipe(recipe: Recipe) -> SpecialistsConfig:
    """Return the settings of the specialists.

    Raises:
        UniconError: when the rest of the recipe does not go with them.
    """
    config, environment = recipe.specialists, recipe.environment
    if config is None:
        raise UniconError("the recipe has no part `specialists`; take the recipe specialists")
    if recipe.run.minutes <= 0 or recipe.run.million_samples:
        raise UniconError("specialists: the budget is one of minutes; give --minutes, no --million-samples")
    if environment.action == "kinematic":
        raise UniconError("specialists: with environment.action=kinematic there is nothing to learn")
    if parse_variant(environment.observation, environment.stride).view != "whole":
        raise UniconError(f"specialists: no teacher can see {environment.observation}; take e.g. tau-1")
    if recipe.variance.mode != "scheduled":
        raise UniconError("specialists: expected variance.mode=scheduled, each stage has its own schedule")
    return config


def generalist_recipe(recipe: Recipe, clips: Sequence[str], minutes: float) -> Recipe:
    """Return that of the run that all specialists begin with."""
    return _ordinary(recipe, clips, minutes, check_recipe(recipe).generalist_points)


def specialist_recipe(recipe: Recipe, clips: Sequence[str], minutes: float) -> Recipe:
    """Return that of a specialist: on one core."""
    made = _ordinary(recipe, clips, minutes, recipe.variance.points)
    return replace(
        made,
        environment=replace(made.environment, threads=1),
        learner=replace(made.learner, threads=1),
        run=replace(made.run, tensorboard=False),
    )


def student_recipe(recipe: Recipe, clips: Sequence[str], minutes: float) -> Recipe:
    """Return that of the distillation and of PPO with the student's networks."""
    config = check_recipe(recipe)
    made = _ordinary(recipe, clips, minutes, config.finetuning_points)
    return replace(made, network=config.student, description="a student of specialists")


def _ordinary(recipe: Recipe, clips: Sequence[str], minutes: float, points: Points) -> Recipe:
    return replace(
        recipe,
        specialists=None,
        dataset=replace(recipe.dataset, clips=tuple(clips)),
        variance=replace(recipe.variance, points=points, axis="progress"),
        run=replace(recipe.run, minutes=minutes),
    )
