"""Recipes: everything that a training depends on besides the library of motions, as small YAML files.

Those that come with the program lie in ``recipes/``; a path to any other file is as good. What a file does
not name has the default of its dataclass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.train.environment.dataset import DatasetConfig
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.learning.learner import LearnerConfig
from unicon.train.learning.networks import NetworkConfig
from unicon.train.learning.ppo import PPOConfig
from unicon.train.learning.variance_controller import VarianceConfig
from unicon.train.runs.settings import build, plain
from unicon.train.runs.training_run import RunConfig
from unicon.train.specialists.config import SpecialistsConfig

RECIPES = Path(__file__).parent / "recipes"


@dataclass(frozen=True)
class Recipe:
    """All settings of a training."""

    description: str = ""
    """What it is for."""
    dataset: DatasetConfig = field(default_factory=DatasetConfig)
    """Which clips of the library are learned."""
    environment: EnvironmentConfig = field(default_factory=EnvironmentConfig)
    """Action mode, rates, episodes, reward."""
    network: NetworkConfig = field(default_factory=NetworkConfig)
    """Sizes of the networks."""
    variance: VarianceConfig = field(default_factory=VarianceConfig)
    """Schedule of the noise."""
    ppo: PPOConfig = field(default_factory=PPOConfig)
    """How the policy is improved."""
    learner: LearnerConfig = field(default_factory=LearnerConfig)
    """Size of an iteration, device."""
    run: RunConfig = field(default_factory=RunConfig)
    """Budget, checkpoints, logs."""
    specialists: SpecialistsConfig | None = None
    """Stages of a training by specialists; none: an ordinary run."""


def read_recipe(name: str | Path, changes: Sequence[str] = ()) -> Recipe:
    """Read a recipe.

    Args:
        name: of one that comes with the program, or the path of a YAML file.
        changes: settings that replace the file's, each as ``ppo.epochs=1``.

    Raises:
        UnknownNameError: when there is no such recipe.
        InputFileError: when the file or a change says something that is not a setting.
    """
    path = Path(name)
    if path.suffix != ".yaml":
        path = RECIPES / f"{name}.yaml"
        if not path.is_file():
            known = ", ".join(sorted(p.stem for p in RECIPES.glob("*.yaml")))
            raise UnknownNameError(f"there is no recipe {str(name)!r}; known are {known}, or a file *.yaml")
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "is no text"
        raise InputFileError(f"{path}: cannot be read ({reason})") from error
    except yaml.YAMLError as error:
        raise InputFileError(f"{path}: is not YAML ({' '.join(str(error).split())})") from error
    build(Recipe, values, str(path))  # so that the file's own mistakes are told with its name
    for change in changes:
        _apply(values, change)
    return build(Recipe, values, "--set" if changes else str(path))


def recipe_text(recipe: Recipe) -> str:
    """Return a recipe with every setting, as YAML that ``read_recipe`` reads."""
    return yaml.safe_dump(plain(recipe), sort_keys=False, default_flow_style=None, width=110)


def _apply(values: dict[str, Any], change: str) -> None:
    """Write one ``a.b=value`` into nested mappings."""
    place, equals, text = change.partition("=")
    *groups, last = place.strip().split(".")
    if not equals or not last:
        raise UniconError(f"--set {change}: expected a setting and its value, such as ppo.epochs=1")
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise UniconError(f"--set {change}: the value is not YAML") from error
    for group in groups:
        values = values.setdefault(group, {})
        if not isinstance(values, dict):
            raise UniconError(f"--set {change}: {group} has no settings within it")
    values[last] = value
