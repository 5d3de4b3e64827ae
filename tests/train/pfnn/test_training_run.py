"""Tests for training_run.py and what it writes: state, plots, model card; and for stop_signals.py."""

import io
import json
import os
import signal
from dataclasses import replace

import pytest
import torch
from rich.console import Console

from tests.train.pfnn.toy_gait import make_toy_data
from unicon.errors import InputFileError, UniconError
from unicon.schedulers.pfnn.network_file import find_network, read_network
from unicon.train.pfnn import training_state
from unicon.train.pfnn.network_facts import card_of_data
from unicon.train.pfnn.training import NetworkTrainer
from unicon.train.pfnn.training_config import NetworkTrainingConfig
from unicon.train.pfnn.training_run import NetworkTrainingRun
from unicon.train.pfnn.training_state import STATE_FILE, read_state, write_state
from unicon.train.runs.stop_signals import StopSignals

CONFIG = NetworkTrainingConfig(minutes=0.0, steps=60, hidden=8, minibatch=16, judge_seconds=1e9)
DATA = make_toy_data(takes=3, frames=60)


def _make_run(folder, config=CONFIG):
    trainer = NetworkTrainer(DATA, config)
    base = card_of_data("toy", DATA, (), config.seed)

    def describe(error, seconds):
        return replace(base, held_out_error={**error.parts, "loss": error.loss})

    console = Console(file=io.StringIO(), width=150)
    return NetworkTrainingRun(trainer, folder, console, describe)


def _same(one, other):
    pairs = zip(one.network.state_dict().values(), other.network.state_dict().values(), strict=True)
    return all(torch.equal(a, b) for a, b in pairs)


def test_a_run_leaves_a_network_its_card_its_curves_and_its_log(tmp_path):
    run = _make_run(tmp_path)
    assert run.train() == "finished"
    assert run.trainer.steps == 60
    folder = tmp_path / "pfnn"
    names = ["README.md", "pfnn.json", "pfnn.safetensors", "training.png"]
    assert sorted(path.name for path in folder.iterdir()) == names
    card, network = read_network(find_network(str(folder)))
    assert card.held_out_error["loss"] == pytest.approx(run.trainer.judge().loss)
    assert network.sizes == (305, 8, 8, 109)
    text = (folder / "README.md").read_text()
    assert "| hinge angles |" in text
    assert "1 takes that it has never seen" in text
    rows = [json.loads(line) for line in (tmp_path / "metrics.jsonl").read_text().splitlines()]
    assert [row["iteration"] for row in rows] == [60]
    assert rows[0]["held_out/joint_pos"] > 0
    assert "60 steps: held-out loss" in run.console.file.getvalue()


def test_a_run_that_went_on_is_the_same_to_the_bit(tmp_path):
    whole = _make_run(tmp_path / "whole")
    (tmp_path / "whole").mkdir()
    whole.train()
    parts = tmp_path / "parts"
    parts.mkdir()
    half = _make_run(parts)
    for _ in range(30):
        half.trainer.step(half.progress)
    write_state(parts / STATE_FILE, half.trainer, 1.5)
    rest = _make_run(parts)
    assert (rest.trainer.steps, rest.seconds, rest.progress) == (30, 1.5, 0.5)
    for _ in range(30):
        rest.trainer.step(rest.progress)
    steps = NetworkTrainer(DATA, CONFIG)
    for step in range(60):
        steps.step(step / 60)
    assert _same(rest.trainer, steps)
    assert _same(whole.trainer, steps)


def test_judgements_come_when_they_are_due(tmp_path):
    run = _make_run(tmp_path, replace(CONFIG, judge_seconds=0.0))
    run.train()
    rows = [json.loads(line) for line in (tmp_path / "metrics.jsonl").read_text().splitlines()]
    assert [row["iteration"] for row in rows] == [25, 50, 60, 60]
    assert "loss/training" in rows[0]


def test_ctrl_c_saves_and_ends(tmp_path):
    run = _make_run(tmp_path)
    learn, trainer = run.trainer.step, run.trainer

    def interrupted(progress):
        if trainer.steps == 12:
            os.kill(os.getpid(), signal.SIGINT)
        return learn(progress)

    trainer.step = interrupted
    assert run.train() == "stopped"
    assert trainer.steps == 13
    assert _make_run(tmp_path).trainer.steps == 13
    assert (tmp_path / "pfnn" / "pfnn.safetensors").is_file()


def test_a_second_signal_interrupts_at_once_and_the_handler_comes_back():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), StopSignals() as stop:
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.asked
        os.kill(os.getpid(), signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_a_loss_that_is_not_finite_ends_the_run(tmp_path):
    run = _make_run(tmp_path)
    run.trainer.step = lambda _: torch.tensor(float("nan"))
    with pytest.raises(UniconError, match="the loss is not finite"):
        run.train()


def test_a_state_of_another_network_or_a_damaged_one_is_refused(tmp_path):
    path = tmp_path / STATE_FILE
    run = _make_run(tmp_path)
    run.trainer.step(0.0)
    write_state(path, run.trainer, 0.0)
    with pytest.raises(InputFileError, match="not of a network of these sizes"):
        read_state(path, NetworkTrainer(DATA, replace(CONFIG, hidden=9)))
    path.write_bytes(path.read_bytes()[:500])
    with pytest.raises(InputFileError, match="cannot be read as safetensors"):
        read_state(path, run.trainer)
    (tmp_path / "other.safetensors").write_bytes((2).to_bytes(8, "little") + b"{}")
    with pytest.raises(InputFileError, match="has the format None"):
        read_state(tmp_path / "other.safetensors", run.trainer)


def test_a_full_disk_leaves_the_state_before(tmp_path, monkeypatch):
    run = _make_run(tmp_path)
    run.trainer.step(0.0)
    write_state(tmp_path / STATE_FILE, run.trainer, 2.0)

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(training_state, "save_file", full)
    with pytest.raises(UniconError, match="No space left on device"):
        write_state(tmp_path / STATE_FILE, run.trainer, 3.0)
    assert read_state(tmp_path / STATE_FILE, run.trainer).seconds == 2.0
    assert [path.name for path in tmp_path.iterdir()] == [STATE_FILE]
