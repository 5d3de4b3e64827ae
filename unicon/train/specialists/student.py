"""The stage in which a student learns from the best specialist of each clip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from unicon.train.environment.dataset import Dataset
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.compute import choose_device, choose_dtype
from unicon.train.learning.networks import ActorCritic
from unicon.train.runs.checkpoint import checkpoints_of, read_networks
from unicon.train.runs.recipe import Recipe, read_recipe
from unicon.train.runs.run_folder import CONFIG_FILE
from unicon.train.runs.trained_policy import make_evaluation
from unicon.train.runs.training_run import TrainingRun
from unicon.train.specialists.config import DistillationConfig
from unicon.train.specialists.distillation import Distiller
from unicon.train.specialists.part_training import open_stage
from unicon.train.specialists.plan import StageResult
from unicon.train.specialists.teachers import read_teachers


@dataclass(frozen=True)
class Lessons:
    """What the student learns from, and where it is written."""

    folder: Path
    """Of its run."""
    teachers: Mapping[str, Path]
    """The run of the teacher of each clip, by the clip's name."""
    generalist: Path
    """Run whose normalisation a new student begins with: it has seen everything."""
    before: Path | None = None
    """Run of the student of the round before, whose networks it begins with."""


def teach_student(
    lessons: Lessons, dataset: Dataset, recipe: Recipe, config: DistillationConfig, console: Console
) -> StageResult | None:
    """Distil the teachers, or go on with it; return how it went, None where it was stopped.

    Raises:
        UniconError: when a clip has no teacher, or a run cannot be read.
    """
    environment = TrackingEnvironment(dataset, recipe.environment, say=console.print)
    device = choose_device(recipe.learner.device)
    dtype = choose_dtype(recipe.learner.precision, device)
    sizes = environment.observation_size, environment.action_size
    names = [info.name for info in dataset.infos]
    teachers = read_teachers(lessons.teachers, names, *sizes, dtype, device)
    distiller = Distiller(environment, recipe, teachers, config)
    if lessons.before is None and not checkpoints_of(lessons.folder):
        _take_normalization(distiller.network, lessons.generalist)
    open_stage(lessons.folder, recipe, distiller, lessons.before)
    console.print(f"{len(teachers.networks)} teachers of {len(names)} clips")
    run = TrainingRun(distiller, lessons.folder, console, make_evaluation(dataset, recipe))
    return None if run.train() == "stopped" else StageResult(run.seconds)


def _take_normalization(student: ActorCritic, generalist: Path) -> None:
    """Give a student that knows nothing yet the normalisation of the observations."""
    shapes = len(student.normalizer.mean), len(student.log_std)
    network = ActorCritic(*shapes, read_recipe(generalist / CONFIG_FILE).network)
    read_networks(generalist, network)
    student.normalizer.load_state_dict(network.normalizer.state_dict())
