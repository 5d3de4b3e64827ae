import io
import json
from pathlib import Path

import pytest
from rich.console import Console

from tests.samples import swaying_clip
from tests.train.small_library import CLIPS, make_library
from tests.train.specialists.samples import small_recipe
from unicon.errors import UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library_writer import LibraryWriter
from unicon.train.runs.recipe import read_recipe, recipe_text
from unicon.train.runs.run_folder import CONFIG_FILE
from unicon.train.runs.trained_policy import read_trained
from unicon.train.specialists.plan import Plan, read_plan
from unicon.train.specialists.specialists_run import train_specialists
from unicon.train.train_commands import Train

QUIET = Console(quiet=True)


class KilledError(Exception):
    """Stands for a kill."""


def _train(library: Path, out: Path, *changes: str, resume: bool = False) -> str:
    return train_specialists(library, out, small_recipe(*changes), QUIET, resume)


def _starts(out: Path) -> dict[str, int]:
    """Return how often each stage was started."""
    return {
        str(path.parent.relative_to(out)): len(path.read_text().splitlines())
        for path in out.rglob("starts.jsonl")
        if path.parent != out
    }


def _larger_library(folder: Path) -> Path:
    """The small library and one more clip, which belongs to a class that has clusters."""
    with LibraryWriter(folder) as writer:
        for row, info in enumerate((*CLIPS, ClipInfo("waltz", 70, "dance"))):
            writer.add(info, swaying_clip(info.frames, speed=0.1 * (row + 1)).frames)
        writer.commit()
    return folder


def test_all_stages_are_done_and_each_is_an_ordinary_run(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    assert _train(library, out) == "finished"
    plan = read_plan(out)
    assert {c.name: c.clips for c in plan.clusters if not c.single} == {
        "dance": ("dance",),
        "walking": ("walk_b", "walk_a"),
    }
    singles = [c for c in plan.clusters if c.single]
    assert {c.clips[0] for c in singles} <= {"dance", "walk_a", "walk_b"}
    assert singles
    assert singles[0].begins_from in ("specialists/dance", "specialists/walking")
    stages = {"generalist", "student", "finetuned", *(c.stage for c in plan.clusters)}
    assert set(plan.done) == {*stages, "scores of round 1"}
    assert _starts(out) == dict.fromkeys(stages, 1)
    for stage in stages:
        card, weights = read_trained(out / stage, "name")
        assert card.action == "pd"
        hidden = 64 if stage in ("student", "finetuned") else 16
        assert weights.sizes == (403, hidden, 35)
        assert read_recipe(out / stage / CONFIG_FILE).specialists is None


def test_a_stage_is_gone_on_with_by_the_usual_command(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    _train(library, out)
    run = out / "specialists/walking"
    before = [json.loads(line) for line in (run / "metrics.jsonl").read_text().splitlines()]
    # the last iteration may have overrun the budget by any time
    spent = max(read_recipe(run / CONFIG_FILE).run.minutes, before[-1]["time/seconds"] / 60.0)
    minutes = spent + 0.01
    Train(library, run, resume=True, minutes=minutes).run(Console(file=io.StringIO()))
    rows = [json.loads(line) for line in (run / "metrics.jsonl").read_text().splitlines()]
    assert len(rows) > len(before)
    assert [row["iteration"] for row in rows] == list(range(1, len(rows) + 1))


@pytest.mark.parametrize("written", [True, False])
def test_after_a_kill_at_the_end_of_any_stage_it_goes_on_there(tmp_path, monkeypatch, written):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    finish, killed = Plan.finish, set()

    def finish_and_die(plan, stage, result):
        if written or stage in killed:
            finish(plan, stage, result)
        if stage not in killed:
            killed.add(stage)
            raise KilledError

    monkeypatch.setattr(Plan, "finish", finish_and_die)
    resume = False
    while True:
        try:
            assert _train(library, out, resume=resume) == "finished"
            break
        except KilledError:
            resume = True
    assert {"generalist", "specialists/walking", "student", "finetuned"} <= killed
    # those that were written down are not started again; of the others nothing is learned anew
    assert set(_starts(out).values()) == {1 if written else 2}
    for path in out.rglob("metrics.jsonl"):
        iterations = [json.loads(line)["iteration"] for line in path.read_text().splitlines()]
        assert iterations == list(range(1, len(iterations) + 1))


def test_what_was_stopped_before_its_first_checkpoint_begins_anew(tmp_path, monkeypatch):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    with monkeypatch.context() as patch:
        patch.setattr("unicon.train.runs.training_run.TrainingRun.train", _die)
        with pytest.raises(KilledError):
            _train(library, out)
    assert _starts(out) == {"generalist": 1}
    assert _train(library, out, resume=True) == "finished"


def _die(*_: object) -> None:
    raise KilledError


def test_ctrl_c_stops_and_nothing_is_taken_for_done(tmp_path, monkeypatch):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    with monkeypatch.context() as patch:
        patch.setattr("unicon.train.runs.training_run.TrainingRun.train", lambda *_: "stopped")
        assert _train(library, out) == "stopped"
    assert read_plan(out).done == {}


def test_new_clips_get_specialists_and_the_student_learns_them_without_starting_over(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    _train(library, out)
    first = _starts(out)
    larger = _larger_library(tmp_path / "larger")
    assert _train(larger, out, resume=True) == "finished"
    plan = read_plan(out)
    new = [c for c in plan.clusters if c.round == 2 and not c.single]
    assert [(c.name, c.clips) for c in new] == [("dance-2", ("waltz",))]
    second = _starts(out)
    assert {stage: second[stage] for stage in first} == first
    assert {"specialists/dance-2", "student-2", "finetuned-2"} <= set(second) - set(first)
    assert "waltz" in read_recipe(out / "student-2" / CONFIG_FILE).dataset.clips
    # nothing is left to do
    assert _train(larger, out, resume=True) == "finished"
    assert _starts(out) == second


def test_another_round_takes_up_the_clips_that_still_fail(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    _train(library, out)
    _train(library, out, "specialists.rounds=2", resume=True)
    again = [c for c in read_plan(out).clusters if c.round == 2]
    assert again
    assert all(c.single and c.name.endswith("-2") for c in again)


def test_a_mastered_cluster_ends_early(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    noises = ("position_noise_m", "height_noise_m", "joint_noise_rad", "velocity_noise")
    calm = [f"environment.{noise}=0" for noise in noises]
    lenient = ("environment.reward.threshold=0", f"environment.reward.exponents={[1e-9] * 5}")
    _train(library, out, *calm, *lenient)
    plan = read_plan(out)
    assert plan.done["specialists/walking"].seconds == 0.0
    assert not [c for c in plan.clusters if c.single]
    read_trained(out / "specialists/walking", "name")


def test_specialists_train_in_processes_of_their_own(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    assert _train(library, out, "specialists.jobs=2", "specialists.singles_share=0") == "finished"
    assert "specialists/dance" in read_plan(out).done


def test_the_command_begins_and_goes_on(tmp_path):
    library, out = make_library(tmp_path / "library").folder, tmp_path / "run"
    recipe = tmp_path / "mine.yaml"
    recipe.write_text(recipe_text(small_recipe()))
    console = Console(file=io.StringIO(), width=200)
    assert Train(library, out, recipe=str(recipe)).run(console) == 0
    printed = console.file.getvalue()
    assert "specialists/walking: masters 0 of 2 clips after" in printed
    assert printed.splitlines()[-1] == f"finished: {out}"
    with pytest.raises(UniconError, match="holds a run already"):
        Train(library, out, recipe=str(recipe)).run(console)
    assert Train(library, out, resume=True).run(console) == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("run.minutes=0", "the budget is one of minutes"),
        ("run.million_samples=1", "the budget is one of minutes"),
        ("environment.action=kinematic", "nothing to learn"),
        ("environment.observation=phase-onehot", "no teacher can see phase-onehot"),
        ("variance.mode=learned", "expected variance.mode=scheduled"),
    ],
)
def test_a_recipe_that_does_not_go_with_specialists_is_refused(tmp_path, change, message):
    library = make_library(tmp_path / "library").folder
    with pytest.raises(UniconError, match=message):
        _train(library, tmp_path / "run", change)
    assert not (tmp_path / "run").exists()
