"""The whole training by specialists: a generalist, specialists, one student of all, and PPO with it.

In the folder of the training lie

    config.yaml                every setting
    plan.json, clusters.yaml   what is done, and which specialist learns which clips
    generalist/                a short run on all clips
    specialists/<cluster>/     a run for each cluster and, afterwards, for single clips that still fail
    student/                   the network that has learned from the best specialist of each clip
    finetuned/                 PPO with the student's networks

each an ordinary run for ``unicon train --resume`` and ``unicon export``. A further round adds specialists,
and a ``student-2/`` that begins with the networks of ``student/``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal

from rich.console import Console

from unicon.errors import UniconError
from unicon.motion.importing.worker_pool import Died, core_count, run_all
from unicon.motion.store.library import ClipLibrary
from unicon.train.environment.dataset import choose_clips
from unicon.train.runs.recipe import Recipe, recipe_text
from unicon.train.runs.run_folder import CONFIG_FILE, open_run
from unicon.train.runs.state_file import write_in_one_step
from unicon.train.specialists import stage_recipes
from unicon.train.specialists.budgets import (
    Budget,
    choose_singles,
    cluster_minutes,
    round_budget,
    single_minutes,
)
from unicon.train.specialists.clusters import GENERALIST, Cluster, make_clusters, single_cluster
from unicon.train.specialists.part_training import Part, measure_part, train_part
from unicon.train.specialists.plan import StageResult, numbered, read_plan
from unicon.train.specialists.student import Lessons, teach_student


class SpecialistsRun:
    """A training by specialists in a folder."""

    def __init__(
        self, library: Path, out: Path, recipe: Recipe, console: Console, init: Path | None = None
    ) -> None:
        """Read where it stands.

        Args:
            library: of the clips.
            out: folder of the training.
            recipe: with ``specialists``.
            console: where to show how it goes.
            init: a run whose networks the generalist begins with.

        Raises:
            UniconError: when the recipe does not fit, or the library or the plan cannot be read.
        """
        self.config = stage_recipes.check_recipe(recipe)
        self.library, self.out, self.recipe, self.console, self.init = library, out, recipe, console, init
        self.dataset = choose_clips(ClipLibrary(library), recipe.dataset)
        self.clips = tuple(info.name for info in self.dataset.infos)
        self.plan = read_plan(out)

    def train(self) -> Literal["finished", "stopped"]:
        """Do what is not done yet; return "stopped" where Ctrl-C came.

        Raises:
            UniconError: when a stage fails; those before it stay.
        """
        number = 0
        while number < len(self.plan.rounds) or self._begin_round():
            number += 1
            if not all(self._stages(number)):
                return "stopped"
        return "finished"

    def _begin_round(self) -> bool:
        """Begin another round where one is wanted or clips are new; return whether there is one."""
        known = {clip for cluster in self.plan.clusters for clip in cluster.clips}
        new = [info for info in self.dataset.infos if info.name not in known]
        number = len(self.plan.rounds) + 1
        if not new and number > self.config.rounds:
            return False
        taken = {cluster.name for cluster in self.plan.clusters}
        clusters = make_clusters(new, self.config.max_clips, self.config.min_clips, taken, number)
        self.plan.begin_round(self.recipe.run.minutes, clusters)
        self.console.print(f"round {number}: {len(new)} new clips in {len(clusters)} clusters")
        return True

    def _stages(self, number: int) -> Iterator[bool]:
        """Do the stages of a round; yield of each whether it came to its end."""
        clusters = self.plan.of_round(number, single=False)
        budget = round_budget(self.plan.rounds[number - 1], self.config, number == 1, bool(clusters))
        if number == 1:
            recipe = stage_recipes.generalist_recipe(self.recipe, self.clips, budget.generalist)
            yield self._do(Part(GENERALIST, self.library, self.out / GENERALIST, recipe, self.init))
        if clusters:
            yield self._train_clusters(number, clusters, budget.clusters)
        yield self._train_singles(number, budget)
        yield self._teach(number, budget.distillation)
        if budget.finetuning:
            stage, student = numbered("finetuned", number), self.out / numbered("student", number)
            recipe = stage_recipes.student_recipe(self.recipe, self.clips, budget.finetuning)
            yield self._do(Part(stage, self.library, self.out / stage, recipe, student))

    def _train_clusters(self, number: int, clusters: Sequence[Cluster], minutes: float) -> bool:
        """Train the specialists of the round's clusters, by how the generalist follows their clips."""
        scores = f"scores of round {number}"
        if scores not in self.plan.done:
            clips = tuple(clip for cluster in clusters for clip in cluster.clips)
            recipe = stage_recipes.generalist_recipe(self.recipe, clips, 0.0)
            part = Part(scores, self.library, self.out / GENERALIST, recipe, None, self.config.noisy_starts)
            self.plan.finish(scores, StageResult(0.0, measure_part(part)))
        shares = cluster_minutes(clusters, minutes, self.plan.done[scores].by_clip())
        return self._do_all([self._specialist(*pair) for pair in zip(clusters, shares, strict=True)])

    def _train_singles(self, number: int, budget: Budget) -> bool:
        """Train specialists of single clips, with what the clusters left besides."""
        spent_s = [self.plan.done[c.stage].seconds for c in self.plan.of_round(number, single=False)]
        minutes = budget.singles + max(0.0, budget.clusters - sum(spent_s) / 60.0)
        singles, least = self.plan.of_round(number, single=True), self.config.single_minutes
        if not singles:
            teachers = self.plan.teachers(number)
            results = {clip: result for clip, (_, result) in teachers.items() if clip in self.clips}
            chosen = choose_singles(results, minutes, least)
            singles = [single_cluster(clip, teachers[clip][0].stage, number) for clip in chosen]
            self.plan.add_clusters(singles)
        each = single_minutes(minutes, len(singles), least)
        return self._do_all([self._specialist(cluster, each) for cluster in singles])

    def _teach(self, number: int, minutes: float) -> bool:
        """Teach the student of the round."""
        stage = numbered("student", number)
        if stage in self.plan.done:
            return True
        self.console.print(f"{stage}: {minutes:.1f} min")
        lessons = Lessons(
            folder=self.out / stage,
            teachers={clip: self.out / c.stage for clip, (c, _) in self.plan.teachers(number).items()},
            generalist=self.out / GENERALIST,
            before=self.out / numbered("student", number - 1) if number > 1 else None,
        )
        recipe = stage_recipes.student_recipe(self.recipe, self.clips, minutes)
        return self._note(
            stage, teach_student(lessons, self.dataset, recipe, self.config.distillation, self.console)
        )

    def _do(self, part: Part) -> bool:
        """Do a part in this process, with all cores, and show how it goes."""
        if part.stage in self.plan.done:
            return True
        self.console.print(f"{part.stage}: {part.recipe.run.minutes:.1f} min")
        return self._note(part.stage, train_part(part, self.console))

    def _do_all(self, parts: Sequence[Part]) -> bool:
        """Do specialists at the same time, each in a process with one core, the longest first."""
        left = [part for part in parts if part.stage not in self.plan.done]
        left.sort(key=lambda part: -part.recipe.run.minutes)
        for part, result in run_all(train_part, left, self.config.jobs or core_count()):
            if isinstance(result, Died):
                raise UniconError(f"{part.stage}: {result.reason}; go on with fewer specialists.jobs")
            if not self._note(part.stage, result):
                return False
            self.console.print(_outcome(part, result), soft_wrap=True, highlight=False)
        return True

    def _note(self, stage: str, result: StageResult | None) -> bool:
        if result is not None:
            self.plan.finish(stage, result)
        return result is not None

    def _specialist(self, cluster: Cluster, minutes: float) -> Part:
        return Part(
            stage=cluster.stage,
            library=self.library,
            folder=self.out / cluster.stage,
            recipe=stage_recipes.specialist_recipe(self.recipe, cluster.clips, minutes),
            init=self.out / cluster.begins_from,
            noisy_starts=self.config.noisy_starts,
            check_seconds=self.config.check_seconds,
        )


def train_specialists(
    library: Path, out: Path, recipe: Recipe, console: Console, resume: bool, init: Path | None = None
) -> Literal["finished", "stopped"]:
    """Begin a training by specialists in a folder, or go on with it.

    Raises:
        UniconError: when it cannot begin there, or a stage fails.
    """
    run = SpecialistsRun(library, out, recipe, console, init)
    if resume:
        # a budget, say, that is new for the rounds to come
        write_in_one_step(out / CONFIG_FILE, recipe_text(recipe))
    else:
        open_run(out, recipe, resume)
    console.print(recipe_text(recipe), highlight=False)
    try:
        return run.train()
    except KeyboardInterrupt:
        # Ctrl-C while this process waits for others; they have saved what they had
        return "stopped"


def _outcome(part: Part, result: StageResult | None) -> str:
    assert result is not None
    mastered = sum(clip.mastered for clip in result.clips)
    minutes = f"{result.seconds / 60:.1f} of {part.recipe.run.minutes:.1f} min"
    return f"{part.stage}: masters {mastered} of {len(result.clips)} clips after {minutes}"
