import io
import json
import sys

import pytest
import tyro
from rich.console import Console

from tests.train.small_library import make_library
from unicon.errors import UniconError
from unicon.train.runs.checkpoint import checkpoints_of
from unicon.train.runs.recipe import read_recipe
from unicon.train.train_commands import Train

SMALL = (
    "environment.simulator=mujoco",
    "environment.num_envs=8",
    "environment.threads=1",
    "network.actor_sizes=[16]",
    "network.critic_sizes=[16]",
    "ppo.minibatch=64",
    "learner.threads=1",
    "run.tensorboard=false",
    "run.minutes=0",
    "run.evaluate_clips=0",
)


@pytest.fixture
def library(tmp_path):
    return make_library(tmp_path / "library").folder


def _train(monkeypatch, library, out, *words):
    """Run the command as from a terminal; return the exit status and what it printed."""
    arguments = ["--library", str(library), "--out", str(out), *words]
    monkeypatch.setattr(sys, "argv", ["unicon", "train", *arguments])
    console = Console(file=io.StringIO(), width=200)
    status = tyro.cli(Train, args=arguments).run(console)
    return status, console.file.getvalue()


def _begin(monkeypatch, library, out, *words):
    budget = ("--million-samples", f"{3 * 8 * 16 / 1e6}")
    return _train(monkeypatch, library, out, "--dataset", "walk", *budget, *words, "--set", *SMALL)


def test_a_run_prints_and_saves_every_setting_and_can_be_prolonged(monkeypatch, library, tmp_path):
    out = tmp_path / "run"
    status, printed = _begin(monkeypatch, library, out, "--seed", "3")
    assert status == 0
    assert "2 clips" in printed
    assert "value_weight: 5.0" in printed
    assert "finished after 3 iterations" in printed
    assert f"min: {out}" in printed
    recipe = read_recipe(out / "config.yaml")
    assert (recipe.dataset.name, recipe.learner.seed, recipe.environment.seed) == ("walk", 3, 3)
    assert [path.name for path in checkpoints_of(out)] == ["00000003"]
    budget = f"{5 * 8 * 16 / 1e6}"
    status, printed = _train(monkeypatch, library, out, "--resume", "--million-samples", budget)
    assert "finished after 5 iterations" in printed
    rows = [json.loads(line) for line in (out / "metrics.jsonl").read_text().splitlines()]
    assert [row["iteration"] for row in rows] == [1, 2, 3, 4, 5]
    assert len((out / "starts.jsonl").read_text().splitlines()) == 2


def test_ctrl_c_ends_with_the_command_to_go_on(monkeypatch, library, tmp_path):
    monkeypatch.setattr("unicon.train.runs.training_run.TrainingRun.train", lambda _: "stopped")
    status, printed = _begin(monkeypatch, library, tmp_path / "run")
    assert status == 0
    assert printed.splitlines()[-1].startswith("stopped after 0 iterations")
    assert "go on with: unicon train --library" in printed.splitlines()[-1]
    assert printed.splitlines()[-1].endswith("--resume")


def test_fine_tuning_begins_with_the_networks_of_another_run(monkeypatch, library, tmp_path):
    _begin(monkeypatch, library, tmp_path / "first")
    status, _ = _begin(monkeypatch, library, tmp_path / "second", "--init", str(tmp_path / "first"))
    assert status == 0
    with pytest.raises(UniconError, match="holds no checkpoint"):
        _begin(monkeypatch, library, tmp_path / "third", "--init", str(tmp_path / "nowhere"))
    assert not (tmp_path / "third").exists()


def test_a_recipe_beside_resume_is_refused(tmp_path):
    with pytest.raises(UniconError, match="leave out --recipe"):
        Train(tmp_path, tmp_path, recipe="paper", resume=True).read_recipe()


def test_where_nothing_is_said_the_recipe_is_laptop(tmp_path):
    assert Train(tmp_path, tmp_path).read_recipe() == read_recipe("laptop")
    changed = Train(tmp_path, tmp_path, minutes=2.5, set=("ppo.epochs=1",)).read_recipe()
    assert (changed.run.minutes, changed.ppo.epochs) == (2.5, 1)
