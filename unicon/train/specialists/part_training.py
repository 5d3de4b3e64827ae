"""Trains one part of the whole, in whatever process: an ordinary run by PPO in a folder of its own.

A specialist is looked at every now and then: it ends when it masters its clips from noisy starts.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from unicon.motion.store.library import ClipLibrary
from unicon.train.environment.dataset import choose_clips
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.learner import Learner
from unicon.train.runs.checkpoint import checkpoints_of, read_networks
from unicon.train.runs.recipe import Recipe
from unicon.train.runs.run_folder import CONFIG_FILE, open_run
from unicon.train.runs.trained_policy import make_evaluation, network_of
from unicon.train.runs.training_run import TrainingRun
from unicon.train.specialists.noisy_starts import NoisyStarts
from unicon.train.specialists.plan import ClipResult, StageResult


@dataclass(frozen=True)
class Part:
    """A training to be done."""

    stage: str
    """Its name in the plan."""
    library: Path
    folder: Path
    """Of its run."""
    recipe: Recipe
    """With its clips and its budget."""
    init: Path | None = None
    """The run whose networks it begins with."""
    noisy_starts: int = 0
    """For how many noisy starts each clip is measured at the end; 0: none."""
    check_seconds: float = 0.0
    """Between looks whether it may end, 0: it does not end early [s]."""


def train_part(part: Part, console: Console | None = None) -> StageResult | None:
    """Train a part, or go on with it; return how it went, None where it was stopped.

    Args:
        part: what to do.
        console: where to show it and to say the scores of the evaluations; nowhere and none without it.

    Raises:
        UniconError: when it cannot begin, or a number is not finite.
    """
    say = console or Console(quiet=True)
    dataset = choose_clips(ClipLibrary(part.library), part.recipe.dataset)
    learner = Learner(TrackingEnvironment(dataset, part.recipe.environment, say=say.print), part.recipe)
    open_stage(part.folder, part.recipe, learner, part.init)
    evaluate = make_evaluation(dataset, part.recipe) if console else None
    run = TrainingRun(learner, part.folder, say, evaluate)
    noisy = NoisyStarts(dataset, part.recipe.environment, part.noisy_starts) if part.noisy_starts else None
    if part.check_seconds and noisy:
        return _train_until_mastered(run, noisy, part.check_seconds)
    if run.train() == "stopped":
        return None
    return StageResult(run.seconds, noisy.measure(learner.network) if noisy else ())


def open_stage(folder: Path, recipe: Recipe, learner: Learner, init: Path | None) -> None:
    """Make or open the folder of a run; what was stopped before its first checkpoint begins anew.

    Raises:
        InputFileError: when there are no networks to begin with.
    """
    resume = bool(checkpoints_of(folder))
    if not resume:
        if init is not None:
            read_networks(init, learner.network)
        if (folder / CONFIG_FILE).is_file():
            shutil.rmtree(folder)
    open_run(folder, recipe, resume)


def measure_part(part: Part) -> tuple[ClipResult, ...]:
    """Return how the policy that a part's folder holds follows the part's clips from noisy starts.

    Raises:
        InputFileError: when the folder holds no checkpoint.
    """
    dataset = choose_clips(ClipLibrary(part.library), part.recipe.dataset)
    network = network_of(part.recipe)
    read_networks(part.folder, network)
    return NoisyStarts(dataset, part.recipe.environment, part.noisy_starts).measure(network)


def _train_until_mastered(run: TrainingRun, noisy: NoisyStarts, check_s: float) -> StageResult | None:
    """Train for some seconds at a time, and look, until all clips are mastered or the time is over."""
    while True:
        results = noisy.measure(run.learner.network)
        if run.progress >= 1.0 or all(clip.mastered for clip in results):
            if not checkpoints_of(run.folder):
                run.train(iterations=0)  # mastered as it was: save it
            return StageResult(run.seconds, results)
        wanted = _iterations_in(run, check_s)
        before = run.learner.iteration
        run.train(wanted)
        if run.progress < 1.0 and run.learner.iteration - before < wanted:
            return None


def _iterations_in(run: TrainingRun, seconds: float) -> int:
    """Return how many iterations take so long, by those that there were."""
    if not run.learner.iteration:
        return 8
    return max(1, round(seconds * run.learner.iteration / run.seconds))
