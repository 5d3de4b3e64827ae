"""Tests for the recipes of the paper's baselines: the same network and tricks as `paper`."""

from __future__ import annotations

from dataclasses import replace

import pytest

from unicon.train.runs.recipe import Recipe, read_recipe


def without(recipe: Recipe, *names: str) -> Recipe:
    """A recipe with some settings of the environment, the evaluations and the description left out."""
    plain = {name: getattr(Recipe().environment, name) for name in names}
    run = replace(recipe.run, evaluate_clips=0)
    return replace(recipe, description="", environment=replace(recipe.environment, **plain), run=run)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("pd", {"action": "pd"}),
        ("kinematic_state", {"action": "pd", "observation": "targets-only"}),
        ("chentanez", {"action": "pd", "observation": "frames-0-4-16-64"}),
        ("deepmimic_onehot", {"action": "pd", "observation": "phase-onehot", "mirror_share": 0.0}),
        ("deepmimic_variable", {"action": "pd", "observation": "phase-number", "mirror_share": 0.0}),
    ],
)
def test_a_baseline_differs_from_paper_in_what_makes_it_one(name, changes):
    baseline = read_recipe(name)
    assert {key: getattr(baseline.environment, key) for key in changes} == changes
    assert without(baseline, *changes) == without(read_recipe("paper"), *changes)
