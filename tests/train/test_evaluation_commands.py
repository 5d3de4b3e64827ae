"""Tests for evaluation_commands.py: what a person types and gets."""

from __future__ import annotations

import json

import pytest
import tyro
from rich.console import Console

from tests.samples import swaying_clip
from tests.train.clip_samples import small_library
from tests.train.policy_samples import make_card, make_weights
from unicon.errors import UniconError
from unicon.policy_file import read_policy
from unicon.train.evaluation_commands import Evaluate, Robustness
from unicon.train.scoring import robustness
from unicon.train.scoring.policy_export import export_policy


def run(command) -> str:
    console = Console(record=True, width=200)
    assert command.run(console) == 0
    return console.export_text()


def test_it_evaluates_the_test_side_and_writes_what_was_asked_for(tmp_path):
    small_library(tmp_path / "library")
    words = ["reference_servo", "--library", str(tmp_path / "library"), "--jobs", "1"]
    words += [
        "--json",
        str(tmp_path / "a.json"),
        "--csv",
        str(tmp_path / "a.csv"),
        "--plot",
        str(tmp_path / "a.png"),
    ]
    text = run(tyro.cli(Evaluate, args=words))
    assert "All of library, split test" in text
    assert json.loads((tmp_path / "a.json").read_text())["all"]["clips"] == 2
    assert (tmp_path / "a.csv").stat().st_size and (tmp_path / "a.png").stat().st_size
    first = (tmp_path / "a.json").read_bytes()
    run(tyro.cli(Evaluate, args=words))
    assert (tmp_path / "a.json").read_bytes() == first


def test_it_evaluates_a_folder_of_clips(tmp_path):
    swaying_clip(40, name="one").save(tmp_path / "one.npz")
    assert "100.0%" in run(Evaluate("kinematic", clips=tmp_path, jobs=1))


def test_scores_are_saved_into_the_policys_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(robustness, "TRIALS", ())
    swaying_clip(40, name="one").save(tmp_path / "one.npz")
    card = make_card()
    export_policy(tmp_path / "p", card, make_weights(card))
    run(Evaluate(f"{tmp_path}/p", clips=tmp_path / "one.npz", save=True, jobs=1))
    run(Robustness(f"{tmp_path}/p", clips=tmp_path / "one.npz", save=True, jobs=1))
    assert set(read_policy(tmp_path / "p")[0].scores) >= {"survival", "success"}
    assert "## Robustness" in (tmp_path / "p" / "README.md").read_text()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"save": True}, "--save: reference_servo has no folder"),
        ({"library": "x", "clips": "y"}, "not both"),
    ],
)
def test_what_does_not_go_together_is_refused(changes, said):
    with pytest.raises(UniconError, match=said):
        Evaluate("reference_servo", **changes).run(Console(quiet=True))
