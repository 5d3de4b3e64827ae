"""Tests for comparison.py and comparison_report.py."""

from __future__ import annotations

import csv
import json
import math

import pytest
from rich.console import Console

from tests.train.small_library import make_library
from unicon.errors import UniconError
from unicon.train.runs.checkpoint import checkpoints_of, read_numbers
from unicon.train.scoring import comparison
from unicon.train.scoring.comparison import ComparisonConfig, compare
from unicon.train.scoring.comparison_report import CurvePoint, Outcome, read_curve, table, write_report

SMALL = (
    "environment.simulator=mujoco",
    "environment.num_envs=8",
    "environment.threads=1",
    "network.actor_sizes=[16]",
    "network.critic_sizes=[16]",
    "ppo.minibatch=64",
    "learner.threads=1",
    "learner.steps=4",
    "run.tensorboard=false",
    "run.minutes=0",
    f"run.million_samples={3 * 8 * 4 / 1e6}",
    "run.evaluate_minutes=0",
)
CONFIG = ComparisonConfig(minutes=1.0, dataset="walk", jobs=1, curve_clips=2)


@pytest.fixture
def library(tmp_path):
    return make_library(tmp_path / "library")


def go(library, out, *recipes, changes=SMALL):
    console = Console(record=True, width=250)
    return compare(library, out, recipes, CONFIG, console, changes), console.export_text()


def test_recipes_are_trained_scored_and_put_side_by_side(library, tmp_path):
    out = tmp_path / "out"
    outcomes, text = go(library, out, "laptop", "laptop+no-rsis", "deepmimic_onehot")
    assert [outcome.name for outcome in outcomes] == ["laptop", "laptop+no-rsis", "deepmimic_onehot"]
    assert outcomes[0].train and outcomes[0].test and outcomes[2].train
    assert outcomes[2].test is None
    assert all(outcome.million_samples == pytest.approx(96e-6) for outcome in outcomes)
    assert all(len(outcome.curve) == 1 for outcome in outcomes)
    assert "laptop+no-rsis" in text and "train / test" in text
    values = json.loads((out / "comparison.json").read_text())
    assert [run["name"] for run in values["runs"]] == [outcome.name for outcome in outcomes]
    with (out / "comparison.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[1]["train_survival"]) == outcomes[1].train["survival"]
    assert rows[2]["test_survival"] == ""
    assert (out / "comparison.md").read_text().count("\n") == 5
    assert (out / "comparison.png").stat().st_size > 1000


def test_specialists_are_scored_by_their_student_with_the_cost_of_all_stages(library, tmp_path):
    changes = (
        "environment.num_envs=32",
        "environment.threads=1",
        "network.actor_sizes=[16]",
        "network.critic_sizes=[16]",
        "ppo.minibatch=64",
        "learner.threads=1",
        "learner.steps=8",
        "run.tensorboard=false",
        "run.minutes=0.005",
        "run.evaluate_clips=2",
        "specialists.jobs=1",
        "specialists.min_clips=1",
        "specialists.noisy_starts=1",
        "specialists.singles_share=0",
        "specialists.student.actor_sizes=[32]",
        "specialists.student.critic_sizes=[16]",
        "specialists.distillation.minibatch=64",
        "specialists.distillation.replay_mb=8",
    )
    (outcome,), _ = go(library, tmp_path / "out", "specialists", changes=changes)
    stages = ("generalist", "specialists/walking", "student")
    assert outcome.train and outcome.test
    runs = [tmp_path / "out" / "specialists" / stage for stage in stages]
    samples = [read_numbers(checkpoints_of(run)[-1]).samples for run in runs]
    assert outcome.million_samples == pytest.approx(sum(samples) / 1e6)


def test_what_is_finished_is_not_done_again(library, tmp_path, monkeypatch):
    first, _ = go(library, tmp_path / "out", "laptop")
    monkeypatch.setattr(comparison, "_train_and_score", None)
    again, text = go(library, tmp_path / "out", "laptop")
    assert "laptop: is finished" in text
    assert repr(again) == repr(first)


def test_what_was_stopped_goes_on(library, tmp_path, monkeypatch):
    train = comparison.TrainingRun.train
    monkeypatch.setattr(comparison.TrainingRun, "train", lambda run: train(run, iterations=1))
    assert go(library, tmp_path / "out", "laptop", "paper")[0] == []
    assert not (tmp_path / "out" / "paper").exists()
    monkeypatch.undo()
    outcomes, _ = go(library, tmp_path / "out", "laptop")
    assert outcomes[0].million_samples == pytest.approx(96e-6)
    assert len((tmp_path / "out" / "laptop" / "starts.jsonl").read_text().splitlines()) == 2


def test_a_run_that_died_before_its_first_checkpoint_begins_anew(library, tmp_path, monkeypatch):
    def die(run):
        raise KeyboardInterrupt

    monkeypatch.setattr(comparison.TrainingRun, "train", die)
    with pytest.raises(KeyboardInterrupt):
        go(library, tmp_path / "out", "laptop")
    monkeypatch.undo()
    assert len(go(library, tmp_path / "out", "laptop")[0]) == 1


def test_a_run_with_other_settings_is_not_taken_for_this_one(library, tmp_path):
    go(library, tmp_path / "out", "laptop")
    with pytest.raises(UniconError, match="holds a run with other settings"):
        go(library, tmp_path / "out", "laptop", changes=(*SMALL, "ppo.epochs=1"))


def test_the_same_twice_is_refused(library, tmp_path):
    with pytest.raises(UniconError, match="name each once"):
        go(library, tmp_path / "out", "laptop", "laptop")


def test_the_budget_is_the_same_for_all():
    settings = ComparisonConfig(minutes=30.0, dataset="All", jobs=1, curve_points=6).settings()
    recipe = comparison.read_candidate("paper", settings).recipe
    assert (recipe.run.minutes, recipe.run.million_samples, recipe.run.evaluate_minutes) == (30.0, 0.0, 5.0)
    assert recipe.run.clock == "processor"
    assert recipe.dataset.name == "All"


def test_the_curve_is_read_from_the_log_by_minutes_of_training(tmp_path):
    rows = [
        {"iteration": 1, "time/seconds": 30.0},
        {"iteration": 2, "time/seconds": 60.0},
        {"iteration": 2, "evaluation/survival": 0.5, "evaluation/success": 0.25},
        {"iteration": 3, "time/seconds": 90.0},
        {"iteration": 3, "evaluation/survival": 0.75, "evaluation/success": 0.5},
    ]
    (tmp_path / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    assert read_curve(tmp_path) == (CurvePoint(1.0, 0.5, 0.25), CurvePoint(1.5, 0.75, 0.5))


FIGURES = {
    "survival": 0.5,
    "success": 0.25,
    "success_s3": 0.125,
    "reward": 0.375,
    "root_relative_mm": math.nan,
    "chatter": 0.01,
}


def test_an_outcome_comes_back_from_its_file_and_no_number_is_shown_as_a_dash(tmp_path):
    outcome = Outcome("laptop", 2.0, 1.2, FIGURES, None, (CurvePoint(1.0, 0.5, 0.25),))
    values = json.loads(json.dumps(outcome.as_json()))
    assert values["train"]["root_relative_mm"] is None
    assert repr(Outcome.from_json(values)) == repr(outcome)
    assert outcome.samples_per_s == pytest.approx(10_000)
    write_report(tmp_path, [outcome], "Walk", 2.0)
    row = (tmp_path / "comparison.md").read_text().splitlines()[2]
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[:4] == ["laptop", "2.0", "1.20", "10000"]
    shown = ["0.500", "25.0%", "12.5%", "0.375", "-", "0.010"]
    assert cells[4:] == [f"{text} / -" for text in shown]
    assert table([outcome], "Walk").row_count == 1
