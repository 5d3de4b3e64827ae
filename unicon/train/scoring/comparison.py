"""Trains recipes one after the other with the same budget, and scores each on both sides of the split.

Each has a run in a folder of its own, which goes on where it was stopped; ``scores.json`` there says that it
is finished. After each the table and the plot of all that are finished are written
(``comparison_report.py``).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console

from unicon.errors import InputFileError, UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.policy_file import PolicyWeights
from unicon.train.environment.dataset import Dataset, choose_clips
from unicon.train.environment.observation_views import as_seen
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.learner import Learner
from unicon.train.learning.networks import export_weights
from unicon.train.runs.checkpoint import checkpoints_of, read_numbers
from unicon.train.runs.recipe import Recipe, read_recipe, recipe_text
from unicon.train.runs.run_folder import CONFIG_FILE, RunFolder, open_run
from unicon.train.runs.trained_policy import read_trained
from unicon.train.runs.training_run import Evaluate, TrainingRun
from unicon.train.scoring.ablations import Candidate, read_candidate
from unicon.train.scoring.baseline_policies import score_network
from unicon.train.scoring.comparison_report import Outcome, read_curve, table, write_report
from unicon.train.scoring.evaluation import Evaluation, summarise
from unicon.train.scoring.evaluation_clips import ClipSource
from unicon.train.scoring.evaluation_report import write_json
from unicon.train.specialists.plan import read_plan
from unicon.train.specialists.specialists_run import train_specialists

SCORES_FILE = "scores.json"
SPLITS = ("train", "test")


@dataclass(frozen=True)
class ComparisonConfig:
    """What is the same for all."""

    minutes: float
    """Budget of each: processor time of its training [core min]."""
    dataset: str
    """Sub-dataset that is learned and scored."""
    jobs: int
    """Processes of an evaluation; 0: one a core."""
    curve_points: int = 6
    """How often each is scored while it learns."""
    curve_clips: int = 16
    """On how many clips of those it learns, then."""

    def settings(self) -> tuple[str, ...]:
        """Return the changes to every recipe."""
        return (
            f"dataset.name={self.dataset}",
            f"run.minutes={self.minutes}",
            "run.clock=processor",
            "run.million_samples=0",
            f"run.evaluate_minutes={self.minutes / self.curve_points}",
        )


def compare(
    library: ClipLibrary,
    out: Path,
    recipes: Sequence[str],
    config: ComparisonConfig,
    console: Console,
    changes: Sequence[str] = (),
) -> list[Outcome]:
    """Train and score what is not finished yet; return the outcomes so far, in the order of the recipes.

    Args:
        library: with the clips.
        out: folder of the runs, the table and the plot.
        recipes: as ``read_candidate`` takes them.
        config: the budget.
        console: for progress.
        changes: settings of all, stronger than the recipes', weaker than their switches.

    Raises:
        UniconError: when a recipe is none, or a run there has other settings.
    """
    candidates = [read_candidate(text, (*config.settings(), *changes)) for text in recipes]
    if len({candidate.name for candidate in candidates}) < len(candidates):
        raise UniconError("--recipes: two of them are the same; name each once")
    outcomes = [_read_outcome(out, candidate) for candidate in candidates]
    for index, candidate in enumerate(candidates):
        if outcomes[index] is not None:
            console.print(f"{candidate.name}: is finished")
            continue
        console.rule(candidate.name)
        outcomes[index] = _train_and_score(library, out, candidate, config, console)
        finished = [outcome for outcome in outcomes if outcome]
        if outcomes[index] is None:
            return finished
        write_report(out, finished, config.dataset, config.minutes)
        console.print(table(finished, config.dataset))
    return [outcome for outcome in outcomes if outcome]


def _train_and_score(
    library: ClipLibrary, out: Path, candidate: Candidate, config: ComparisonConfig, console: Console
) -> Outcome | None:
    """Return the outcome, or None where someone stopped it."""
    folder = out / candidate.name
    learned = choose_clips(library, candidate.recipe.dataset)
    by_specialists = candidate.recipe.specialists is not None
    train = _train_specialists if by_specialists else _train
    trained = train(folder, candidate, learned, config, console)
    if trained is None:
        return None
    scores: dict[str, dict[str, float] | None] = {}
    for split, infos in zip(SPLITS, (learned.infos, _test_infos(library, candidate)), strict=True):
        source = ClipSource(f"{config.dataset}, split {split}", tuple(infos), library.folder)
        done = _score(trained, learned, source, candidate, config) if infos else None
        scores[split] = summarise(done)[0].figures if done else None
    outcome = Outcome(
        name=candidate.name,
        minutes=trained.seconds / 60.0,
        million_samples=trained.samples / 1e6,
        train=scores["train"],
        test=scores["test"],
        curve=read_curve(trained.folder),
    )
    settings = recipe_text(candidate.recipe)
    write_json(folder / SCORES_FILE, {"settings": settings, **outcome.as_json()})
    return outcome


class _Trained(NamedTuple):
    """What a training ended with."""

    folder: Path
    """Of the run whose networks are scored."""
    recipe: Recipe
    """That run's."""
    weights: PolicyWeights
    seconds: float
    """Of all stages."""
    samples: int


def _train(
    folder: Path, candidate: Candidate, learned: Dataset, config: ComparisonConfig, console: Console
) -> _Trained | None:
    recipe = candidate.recipe
    environment = as_seen(TrackingEnvironment(learned, recipe.environment, say=console.print))
    learner = Learner(environment, recipe)
    _open(folder, candidate)
    run = TrainingRun(learner, folder, console, _curve(candidate, learned, config))
    if run.train() == "stopped":
        return None
    return _Trained(folder, recipe, export_weights(learner.network), run.seconds, learner.samples)


def _train_specialists(
    folder: Path, candidate: Candidate, learned: Dataset, config: ComparisonConfig, console: Console
) -> _Trained | None:
    resume = (folder / CONFIG_FILE).exists()
    if resume:
        _check_settings(folder, (folder / CONFIG_FILE).read_text(encoding="utf-8"), candidate)
    library = learned.library.folder
    if train_specialists(library, folder, candidate.recipe, console, resume) == "stopped":
        return None
    plan = read_plan(folder)
    last = plan.last_run
    assert last is not None
    recipe = read_recipe(last / CONFIG_FILE)
    # the generalist was scored; that stage trains nothing
    runs = [folder / stage for stage in plan.done if (folder / stage).is_dir()]
    samples = sum(read_numbers(checkpoints_of(run)[-1]).samples for run in runs)
    seconds = sum(result.seconds for result in plan.done.values())
    return _Trained(last, recipe, read_trained(last, candidate.name)[1], seconds, samples)


def _score(
    trained: _Trained, learned: Dataset, source: ClipSource, candidate: Candidate, config: ComparisonConfig
) -> Evaluation | None:
    return score_network(trained.recipe, trained.weights, learned, source, candidate.name, config.jobs)


def _open(folder: Path, candidate: Candidate) -> None:
    """Open the folder of a run, where it may have been begun."""
    run = RunFolder(folder)
    if run.config.exists():
        _check_settings(folder, run.config.read_text(encoding="utf-8"), candidate)
        if run.checkpoint is None:
            run.config.unlink()  # it was stopped before its first checkpoint
    open_run(folder, candidate.recipe, resume=run.checkpoint is not None)


def _check_settings(folder: Path, text: str, candidate: Candidate) -> None:
    if text != recipe_text(candidate.recipe):
        raise UniconError(f"{folder}: holds a run with other settings; remove it, or give another --out")


def _read_outcome(out: Path, candidate: Candidate) -> Outcome | None:
    path = out / candidate.name / SCORES_FILE
    if not path.is_file():
        return None
    try:
        values: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        text = values.pop("settings")
        outcome = Outcome.from_json(values)
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputFileError(f"{path}: cannot be read as scores ({error}); remove it") from error
    _check_settings(path.parent, text, candidate)
    return outcome


def _curve(candidate: Candidate, learned: Dataset, config: ComparisonConfig) -> Evaluate:
    """Return what scores a policy while it learns, on clips evenly from those it learns."""
    infos = learned.infos
    chosen = np.unique(
        np.linspace(0, len(infos) - 1, min(config.curve_clips, len(infos))).round().astype(int)
    )
    source = ClipSource("clips of the training", tuple(infos[i] for i in chosen), learned.library.folder)

    def score(learner: Learner) -> dict[str, float]:
        weights = export_weights(learner.network)
        done = score_network(candidate.recipe, weights, learned, source, candidate.name, config.jobs)
        figures = summarise(done)[0].figures if done else {}
        return {name: value for name, value in figures.items() if np.isfinite(value)}

    return score


def _test_infos(library: ClipLibrary, candidate: Candidate) -> list[ClipInfo]:
    """Return the clips of the test side, none where it has none."""
    try:
        return choose_clips(library, replace(candidate.recipe.dataset, split="test", clips=())).infos
    except UniconError:
        return []
