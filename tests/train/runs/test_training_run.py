import io
import json
import os
import signal

import pytest
import torch
from rich.console import Console
from safetensors.torch import load_file

from tests.train.linear_quadratic import LinearQuadratic, make_learner
from unicon.errors import UniconError
from unicon.train.runs.checkpoint import checkpoints_of, write_checkpoint
from unicon.train.runs.training_run import RunConfig, TrainingRun

SAMPLES_AN_ITERATION = 32 * 16


def _run(folder, evaluate=None, environment=None, **config):
    budget = {"million_samples": 10 * SAMPLES_AN_ITERATION / 1e6, "tensorboard": False}
    learner = make_learner(environment or LinearQuadratic(num_envs=32), run=RunConfig(**{**budget, **config}))
    return TrainingRun(learner, folder, Console(file=io.StringIO()), evaluate)


def _rows(folder):
    return [json.loads(line) for line in (folder / "metrics.jsonl").read_text().splitlines()]


def test_ten_iterations_equal_five_and_five_more_to_the_bit(tmp_path):
    whole, first = tmp_path / "whole", tmp_path / "parts"
    whole.mkdir()
    first.mkdir()
    one = _run(whole)
    assert one.train() == "finished"
    assert _run(first).train(iterations=5) == "stopped"
    two = _run(first)
    assert two.learner.iteration == 5
    assert two.train() == "finished"
    for (name, a), b in zip(
        one.learner.network.state_dict().items(), two.learner.network.state_dict().values(), strict=True
    ):
        assert torch.equal(a, b), name
    saved = [load_file(checkpoints_of(f)[-1] / "learner.safetensors") for f in (whole, first)]
    assert saved[0].keys() == saved[1].keys()
    assert all(torch.equal(saved[0][name], saved[1][name]) for name in saved[0])
    assert [row["iteration"] for row in _rows(first)] == list(range(1, 11))
    for a, b in zip(_rows(whole), _rows(first), strict=True):
        assert {k: v for k, v in a.items() if "time" not in k} == {
            k: v for k, v in b.items() if "time" not in k
        }


class _Interrupting(LinearQuadratic):
    """Presses Ctrl-C in the middle of the third iteration."""

    def step(self, actions):
        if self.count == 40:
            os.kill(os.getpid(), signal.SIGINT)
        return super().step(actions)


def test_ctrl_c_ends_the_iteration_and_saves(tmp_path):
    before = signal.getsignal(signal.SIGINT)
    run = _run(tmp_path, environment=_Interrupting(num_envs=32))
    assert run.train() == "stopped"
    assert run.learner.iteration == 3
    assert [path.name for path in checkpoints_of(tmp_path)] == ["00000003"]
    assert signal.getsignal(signal.SIGINT) is before


def test_what_is_not_finite_stops_with_the_batch_saved_and_the_last_checkpoint_kept(tmp_path):
    run = _run(tmp_path, environment=LinearQuadratic(num_envs=32, bad_at=40))
    run.train(iterations=2)
    good = checkpoints_of(tmp_path)
    with pytest.raises(UniconError, match="iteration 3: a reward is not finite.*00000002"):
        run.train()
    assert checkpoints_of(tmp_path) == good
    batch = load_file(tmp_path / "not_finite.safetensors")
    assert batch["actions"].shape == (SAMPLES_AN_ITERATION, 1)
    assert not torch.isfinite(batch["returns"]).all()


def test_a_full_disk_stops_with_the_last_checkpoint_kept(tmp_path):
    run = _run(tmp_path)
    run.train(iterations=2)
    (tmp_path / "metrics.jsonl").unlink()
    (tmp_path / "metrics.jsonl").symlink_to("/dev/full")
    with pytest.raises(UniconError, match=r"metrics.jsonl: the log cannot be written \(No space left"):
        run.train()
    assert [path.name for path in checkpoints_of(tmp_path)] == ["00000002"]


def test_the_budget_of_samples_is_spent_and_the_noise_is_at_its_last_point(tmp_path):
    run = _run(tmp_path)
    run.train()
    assert run.learner.samples == 10 * SAMPLES_AN_ITERATION
    assert run.progress == 1.0
    assert _rows(tmp_path)[-1]["policy/std"] == pytest.approx(0.1, rel=1e-3)


def test_a_budget_of_minutes_ends_it_as_well(tmp_path):
    run = _run(tmp_path, million_samples=0.0, minutes=0.001)
    assert run.train() == "finished"
    assert run.seconds >= 0.06


def test_the_processors_clock_counts_what_the_training_takes_and_no_waiting(tmp_path, monkeypatch):
    spent = iter(range(100))
    monkeypatch.setattr("time.process_time", lambda: float(next(spent)))
    run = _run(tmp_path, million_samples=0.0, minutes=2.9 / 60.0, clock="processor")
    assert run.train() == "finished"
    assert run.learner.iteration == 3  # each is between two readings, a second apart
    assert run.seconds == 3.0


def test_without_a_budget_it_goes_on_until_it_is_stopped(tmp_path):
    run = _run(tmp_path, million_samples=0.0)
    assert run.left_s is None
    assert run.train(iterations=2) == "stopped"
    assert run.progress == 0.0


def test_the_evaluation_is_asked_in_time_and_at_the_end_and_logged(tmp_path):
    asked = []

    def evaluate(learner):
        asked.append(learner.iteration)
        return {"survival": 0.5}

    _run(tmp_path, evaluate, evaluate_minutes=1e-6).train(iterations=2)
    assert asked == [1, 2]
    _run(tmp_path, evaluate, evaluate_minutes=0).train()
    assert asked == [1, 2, 10]
    assert _rows(tmp_path)[-1] == {"iteration": 10, "evaluation/survival": 0.5}


def test_a_line_shows_how_it_goes(tmp_path):
    run = _run(tmp_path, line_seconds=0.0)
    run.train(iterations=2)
    lines = run.console.file.getvalue().splitlines()
    assert len(lines) == 2
    for word in ("it 2", "samples", "reward", "survive", "KL", "lr", "std 0.", "left"):
        assert word in lines[1]


def test_checkpoints_come_in_time(tmp_path, monkeypatch):
    written = []

    def note(folder, learner, seconds, keep):
        written.append(learner.iteration)
        return write_checkpoint(folder, learner, seconds, keep)

    monkeypatch.setattr("unicon.train.runs.training_run.write_checkpoint", note)
    _run(tmp_path, checkpoint_minutes=1e-6).train(iterations=3)
    assert written == [1, 2, 3]
