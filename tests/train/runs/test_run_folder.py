import json
import sys

import pytest

from tests.train.linear_quadratic import LinearQuadratic, make_learner, recipe
from unicon.errors import UniconError
from unicon.train.runs.checkpoint import write_checkpoint
from unicon.train.runs.recipe import read_recipe
from unicon.train.runs.run_folder import git_commit, open_run


def test_a_run_keeps_its_settings_command_commit_and_seed(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["unicon", "train", "--out", "my run"])
    settings = recipe()
    folder = open_run(tmp_path / "run", settings, resume=False)
    assert read_recipe(folder.config) == settings
    start = json.loads((folder.path / "starts.jsonl").read_text())
    assert start["command"] == "unicon train --out 'my run'"
    assert start["seed"] == 0
    assert start["commit"] == git_commit()
    assert start["from"] is None


def test_a_run_is_not_overwritten(tmp_path):
    open_run(tmp_path, recipe(), resume=False)
    with pytest.raises(UniconError, match="holds a run already; go on with it by --resume"):
        open_run(tmp_path, recipe(), resume=False)


def test_only_a_run_with_a_checkpoint_goes_on(tmp_path):
    with pytest.raises(UniconError, match="no checkpoint to go on from"):
        open_run(tmp_path, recipe(), resume=True)
    write_checkpoint(tmp_path, make_learner(LinearQuadratic(num_envs=4)), 0.0, 1)
    folder = open_run(tmp_path, recipe(), resume=True)
    assert folder.checkpoint is not None
    assert json.loads((tmp_path / "starts.jsonl").read_text())["from"] == "00000000"


def test_a_place_that_cannot_be_written_is_said_so(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UniconError, match="cannot be written there"):
        open_run(tmp_path / "file" / "run", recipe(), resume=False)
