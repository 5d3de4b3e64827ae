"""Tests for ablations.py."""

from __future__ import annotations

import pytest

from unicon.errors import UniconError
from unicon.train.runs.recipe import read_recipe
from unicon.train.scoring.ablations import SWITCHES, read_candidate


def test_a_recipe_alone_is_itself():
    candidate = read_candidate("laptop", ["run.minutes=2"])
    assert candidate.name == "laptop"
    assert candidate.recipe == read_recipe("laptop", ["run.minutes=2"])


@pytest.mark.parametrize(
    ("switch", "part", "name", "value"),
    [
        ("no-balancer", "environment", "balancer", False),
        ("no-failures", "environment", "failure_cap", 1.0),
        ("no-variance-controller", "variance", "mode", "learned"),
        ("no-constraint", "environment", "constraint", False),
        ("no-rsis", "environment", "rsis_share", 0.0),
    ],
)
def test_a_switch_leaves_one_part_out(switch, part, name, value):
    whole, candidate = read_recipe("paper"), read_candidate(f"paper+{switch}")
    assert candidate.name == f"paper+{switch}"
    assert getattr(getattr(whole, part), name) != value
    assert getattr(getattr(candidate.recipe, part), name) == value
    assert candidate.recipe == read_recipe("paper", SWITCHES[switch])


def test_without_rsis_episodes_begin_in_the_target():
    environment = read_candidate("laptop+no-rsis").recipe.environment
    assert environment.rsis_share == 0.0 and max(environment.noises) == 0.0


def test_switches_join_and_win_over_the_settings_of_all():
    recipe = read_candidate("laptop+no-constraint+ppo.epochs=5", ["ppo.epochs=3", "ppo.gamma=0.9"]).recipe
    assert (recipe.environment.constraint, recipe.ppo.epochs, recipe.ppo.gamma) == (False, 5, 0.9)


def test_a_file_gives_a_name_that_a_folder_can_have(tmp_path):
    (tmp_path / "mine.yaml").write_text("")
    name = read_candidate(f"{tmp_path}/mine.yaml+no-rsis").name
    assert "/" not in name and name.endswith("mine.yaml+no-rsis")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("laptopp", "no recipe 'laptopp'"),
        ("laptop+no-luck", "no switch 'no-luck'; known are no-balancer"),
        ("laptop+ppo.epochz=1", "no setting ppo.epochz"),
    ],
)
def test_what_is_not_known_is_refused(text, said):
    with pytest.raises(UniconError, match=said):
        read_candidate(text)
