"""`unicon train`, `unicon average` and `unicon export`: torch is imported only when they are called."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro
from rich.console import Console

if TYPE_CHECKING:
    from unicon.train.environment.observation_views import ViewedEnvironment
    from unicon.train.environment.tracking_environment import TrackingEnvironment
    from unicon.train.learning.distributed import World
    from unicon.train.runs.recipe import Recipe


@dataclass(frozen=True)
class Train:
    """Train a policy on the motions of a library.

    With several processes, GPUs or machines: torchrun --nproc-per-node 2 -m unicon.cli train ...
    """

    library: Path
    """Library of motions to learn from, as `unicon motions import` makes it."""
    out: Path
    """Folder of the run: settings, log, checkpoints."""
    recipe: str | None = None
    """laptop, paper, specialists, or a file *.yaml; laptop where it is not given."""
    dataset: str | None = None
    """Part of the library: All, RunJumpWalk, Casual, SportDance, Animal or Walk; the recipe's where it is not
    given."""
    minutes: float | None = None
    """Budget of training time [min]; the recipe's where it is not given."""
    million_samples: float | None = None
    """Budget of samples [1e6]; the recipe's where it is not given."""
    seed: int | None = None
    """Of everything that is drawn; the recipe's where it is not given."""
    init: Path | None = None
    """Run or checkpoint whose networks to begin with (fine-tuning)."""
    resume: bool = False
    """Go on with the run in the folder, with its settings."""
    set: tuple[str, ...] = ()
    """Settings that replace the recipe's, such as ppo.epochs=1 variance.mode=learned."""

    def run(self, console: Console) -> int:
        """Train until the budget is spent or Ctrl-C."""
        from unicon.train.learning.compute import choose_device
        from unicon.train.learning.distributed import join_world

        recipe = self.read_recipe()
        world = join_world(choose_device(recipe.learner.device))
        try:
            if recipe.specialists is not None:
                return self._train_specialists(recipe, world, console)
            return self._train(recipe, world, console if world.leads else Console(quiet=True))
        finally:
            world.leave()

    def read_recipe(self) -> Recipe:
        """Return the settings: the recipe's, or the run's to go on with, and then what this command says.

        Raises:
            UniconError: when one of them cannot be.
        """
        from unicon.errors import UniconError
        from unicon.train.runs.recipe import read_recipe
        from unicon.train.runs.run_folder import CONFIG_FILE

        if self.resume and (self.recipe or self.init):
            raise UniconError("--resume goes on with the run's own settings; leave out --recipe and --init")
        options = {
            "dataset.name": self.dataset,
            "run.minutes": self.minutes,
            "run.million_samples": self.million_samples,
            "learner.seed": self.seed,
            "environment.seed": self.seed,
        }
        changes = [f"{name}={value}" for name, value in options.items() if value is not None]
        source = self.out / CONFIG_FILE if self.resume else self.recipe or "laptop"
        return read_recipe(source, (*changes, *self.set))

    def _train(self, recipe: Recipe, world: World, console: Console) -> int:
        from unicon.train.learning.learner import Learner
        from unicon.train.runs.checkpoint import read_networks
        from unicon.train.runs.recipe import recipe_text
        from unicon.train.runs.run_folder import open_run
        from unicon.train.runs.trained_policy import make_evaluation
        from unicon.train.runs.training_run import TrainingRun

        environment = make_environment(self.library, recipe, world, console)
        learner = Learner(environment, recipe, world)
        if self.init is not None:
            read_networks(self.init, learner.network)
        if world.leads:
            open_run(self.out, recipe, self.resume)
        world.wait()
        console.print(recipe_text(recipe), highlight=False)
        run = TrainingRun(learner, self.out, console, make_evaluation(environment.dataset, recipe))
        ending = run.train()
        done = f"{ending} after {learner.iteration} iterations, {run.seconds / 60.0:.1f} min"
        return self._say(console, done, stopped=ending == "stopped")

    def _train_specialists(self, recipe: Recipe, world: World, console: Console) -> int:
        from unicon.errors import UniconError
        from unicon.train.specialists.specialists_run import train_specialists

        if world.size > 1:
            raise UniconError("specialists train in processes of their own; leave out torchrun")
        ending = train_specialists(self.library, self.out, recipe, console, self.resume, self.init)
        return self._say(console, ending, stopped=ending == "stopped")

    def _say(self, console: Console, done: str, stopped: bool) -> int:
        """Say how it ended and how to go on."""
        go_on = shlex.join(
            ["unicon", "train", "--library", str(self.library), "--out", str(self.out), "--resume"]
        )
        next_step = f"; go on with: {go_on}" if stopped else f": {self.out}"
        console.print(f"{done}{next_step}", soft_wrap=True, highlight=False)
        return 0


@dataclass(frozen=True)
class Average:
    """Make a run whose networks are the mean of those of others that come from one another.

    It is exported, or trained on with --init, as any run.
    """

    runs: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Folders of two runs or more, or of their checkpoints; settings are those of the first."""
    out: Path
    """Folder of the run to write."""

    def run(self, console: Console) -> int:
        """Write the run and print where it is."""
        from unicon.train.runs.averaging import average_runs

        average_runs(self.runs, self.out)
        console.print(str(self.out), soft_wrap=True)
        return 0


@dataclass(frozen=True)
class Export:
    """Write the policy of a training run as the executor reads it: policies/NAME/."""

    run_folder: Annotated[Path, tyro.conf.Positional]
    """Folder of the run, or of one of its checkpoints."""
    policy: Annotated[Path, tyro.conf.Positional]
    """Folder to write; its last part is the policy's name."""
    training_data: str
    """What it was trained on, with the licences."""
    description: str = ""
    """A sentence about it; the recipe's where it is not given."""
    action: Literal["torque", "torque-servo", "pd"] | None = None
    """What its outputs do; that of the training where it is not given. A policy trained with pd is a
    torque-servo policy as it is."""

    def run(self, console: Console) -> int:
        """Write the folder and print where it is."""
        from unicon.train.runs.trained_policy import read_trained
        from unicon.train.scoring.policy_export import export_policy

        card, weights = read_trained(self.run_folder, self.policy.resolve().name)
        card = replace(
            card,
            training_data=self.training_data,
            description=self.description or card.description,
            action=self.action or card.action,
        )
        export_policy(self.policy, card, weights)
        console.print(str(self.policy), soft_wrap=True)
        return 0


def make_environment(
    library: Path, recipe: Recipe, world: World, console: Console
) -> TrackingEnvironment | ViewedEnvironment:
    """Return the environments of this process.

    Raises:
        UniconError: when the library cannot be read or no clip is left of it.
    """
    from unicon.motion.store.library import ClipLibrary
    from unicon.train.environment.dataset import choose_clips
    from unicon.train.environment.observation_views import as_seen
    from unicon.train.environment.tracking_environment import TrackingEnvironment
    from unicon.train.learning.compute import share_of_processors

    config = recipe.environment
    dataset = choose_clips(ClipLibrary(library), recipe.dataset)
    seconds = sum(info.seconds for info in dataset.infos)
    console.print(f"{len(dataset.rows)} clips, {seconds / 60.0:.1f} min, of {library}", soft_wrap=True)
    if config.threads == 0 and world.size > 1:
        config = replace(config, threads=share_of_processors())
    return as_seen(TrackingEnvironment(dataset, config, world.rank, console.print))
