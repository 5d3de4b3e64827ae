from dataclasses import replace

import pytest
import yaml

from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.train.runs.recipe import RECIPES, Recipe, read_recipe, recipe_text


@pytest.mark.parametrize("path", sorted(RECIPES.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_recipe_that_comes_with_the_program_is_read_and_has_a_budget(path):
    recipe = read_recipe(path.stem)
    assert recipe.description
    assert recipe.run.minutes or recipe.run.million_samples


def test_paper_has_the_papers_numbers():
    recipe = read_recipe("paper")
    assert recipe.environment.num_envs == 4096
    assert recipe.learner.steps == 64
    assert recipe.network.actor_sizes == (1024, 1024, 1024)
    assert recipe.environment.action == "torque"
    assert recipe.ppo.clip == 0.0
    assert recipe.ppo.kl_penalty > 0.0
    assert recipe.variance.mode == "controlled"


def test_the_text_of_a_recipe_has_every_setting_and_is_read_back(tmp_path):
    recipe = read_recipe("laptop", ["ppo.epochs=7", "variance.points=[[0, 0.2], [1, 3e-2]]"])
    assert recipe.ppo.epochs == 7
    assert recipe.variance.points == ((0.0, 0.2), (1.0, 0.03))
    path = tmp_path / "config.yaml"
    path.write_text(recipe_text(recipe))
    assert read_recipe(path) == recipe
    assert set(yaml.safe_load(path.read_text())["ppo"]) == set(vars(recipe.ppo))


def test_an_empty_file_is_the_defaults(tmp_path):
    path = tmp_path / "empty.yaml"
    path.write_text("")
    assert read_recipe(path) == Recipe()
    assert read_recipe(path, ["learner.seed=4"]).learner == replace(Recipe().learner, seed=4)


def test_an_unknown_recipe_is_answered_with_those_there_are():
    with pytest.raises(UnknownNameError, match="'lapto'; known are .*laptop, paper"):
        read_recipe("lapto")


def test_a_missing_file_is_said_so(tmp_path):
    with pytest.raises(InputFileError, match="No such file"):
        read_recipe(tmp_path / "mine.yaml")


def test_what_is_no_yaml_is_said_so(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("ppo: [")
    with pytest.raises(InputFileError, match="mine.yaml: is not YAML"):
        read_recipe(path)


def test_a_mistake_in_the_file_is_told_with_its_name(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("ppo: {epochz: 1}")
    with pytest.raises(
        InputFileError, match=r"mine.yaml: there is no setting ppo.epochz; did you mean epochs"
    ):
        read_recipe(path, ["ppo.epochs=1"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("ppo.epochz=1", "--set: there is no setting ppo.epochz"),
        ("ppo.epochs", "expected a setting and its value"),
        ("ppo.epochs=x", "--set: ppo.epochs is 'x', expected a whole number"),
        ("ppo.gamma=2", "ppo.gamma is 2.0, expected 0 to 1"),
        ("description.x=2", "description has no settings within it"),
        ("ppo.epochs=[", "is not YAML"),
    ],
)
def test_a_mistake_in_a_change_is_told_with_the_change(change, message):
    with pytest.raises(UniconError, match=message):
        read_recipe("laptop", [change])
