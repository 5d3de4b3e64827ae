"""The loop of a training: iterate, log, save, evaluate, until the budget is spent or someone stops it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from rich.console import Console
from safetensors import SafetensorError
from safetensors.torch import save_file

from unicon.errors import UniconError
from unicon.train.learning.learner import IterationReport, Learner
from unicon.train.learning.ppo import NotFiniteError
from unicon.train.runs.checkpoint import checkpoints_of, read_checkpoint, write_checkpoint
from unicon.train.runs.metrics_log import MetricsLog, row_of
from unicon.train.runs.progress_line import ProgressLine
from unicon.train.runs.stop_signals import StopSignals

Evaluate = Callable[[Learner], Mapping[str, float]]
"""Judges the policy as it is, and returns scores for the log."""
BAD_BATCH_FILE = "not_finite.safetensors"


@dataclass(frozen=True)
class RunConfig:
    """Budget of a run, and how often something is written."""

    minutes: float = 0.0
    """Budget of training time, evaluations left out [min]; 0: none."""
    clock: Literal["wall", "processor"] = "wall"
    """What all minutes of a run are: of the wall's clock, or of processor time summed over the threads, which
    is the same however busy the machine is otherwise."""
    million_samples: float = 0.0
    """Budget of samples of all processes [1e6]; 0: none. With it alone a run can be repeated to the bit."""
    checkpoint_minutes: float = 3.0
    """Time between checkpoints [min]."""
    checkpoints_kept: int = 2
    """How many of the newest stay."""
    evaluate_minutes: float = 10.0
    """Time between evaluations [min]; 0: only at the end."""
    evaluate_clips: int = 32
    """How many clips an evaluation takes, evenly from all that are learned; 0: no evaluation."""
    line_seconds: float = 10.0
    """Time between lines where there is no terminal [s]."""
    tensorboard: bool = True
    """Write a log for TensorBoard beside metrics.jsonl."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        if min(self.minutes, self.million_samples, self.evaluate_minutes, self.evaluate_clips) < 0:
            raise UniconError(
                "run: minutes, million_samples, evaluate_minutes and evaluate_clips must not be below 0"
            )
        if self.checkpoint_minutes <= 0 or self.checkpoints_kept < 1:
            raise UniconError("run: expected checkpoint_minutes above 0 and checkpoints_kept of 1 or more")


class TrainingRun:
    """A learner at work in the folder of a run."""

    def __init__(
        self, learner: Learner, folder: Path, console: Console, evaluate: Evaluate | None = None
    ) -> None:
        """Begin, or go on from the newest checkpoint that the folder holds."""
        self.learner, self.folder, self.console = learner, folder, console
        self.config = learner.recipe.run
        self._clock = time.process_time if self.config.clock == "processor" else time.monotonic
        self.seconds = 0.0
        """Spent training by the configured clock, evaluations left out."""
        self._evaluate = evaluate
        self._signals = StopSignals()
        found = checkpoints_of(folder)
        if found:
            self.seconds = read_checkpoint(found[-1], learner).seconds
        self._saved_iteration = learner.iteration if found else -1
        self._last_checkpoint_s = self._last_evaluation_s = self.seconds

    @property
    def progress(self) -> float:
        """Share of the budget that is spent, 0 where there is none."""
        return min(1.0, max((spent / budget for spent, budget in self._budgets()), default=0.0))

    @property
    def left_s(self) -> float | None:
        """Time left [s], by how fast it went so far; None without a budget."""
        if not self._budgets():
            return None
        progress = self.progress
        if progress == 0.0:
            return self.config.minutes * 60.0 or None
        return self.seconds * (1.0 - progress) / progress

    def train(self, iterations: int | None = None) -> Literal["finished", "stopped"]:
        """Train until the budget is spent, or so many iterations are done, or SIGINT or SIGTERM comes.

        Returns:
            "finished" when the budget is spent. A checkpoint is written in any case.

        Raises:
            UniconError: when a number is not finite, or the disk is full; the last checkpoint stays.
        """
        config, world = self.config, self.learner.world
        log = MetricsLog(self.folder, self.learner.iteration, config.tensorboard) if world.leads else None
        quiet = self.console if world.leads else Console(quiet=True)
        done = 0
        try:
            with self._signals, ProgressLine(quiet, config.line_seconds) as line:
                while not self._is_over(done, iterations):
                    report = self._iterate()
                    done += 1
                    if log is not None:
                        log.write(report.iteration, row_of(report, self.seconds))
                    line.show(report, self.left_s)
                    self._save_and_evaluate(log)
            self._save()
            if self.progress >= 1.0:
                self._judge(log)
        finally:
            if log is not None:
                log.close()
        return "finished" if self.progress >= 1.0 else "stopped"

    def _budgets(self) -> list[tuple[float, float]]:
        """Return what is spent and what may be, of each budget there is."""
        spent = (
            (self.seconds / 60.0, self.config.minutes),
            (
                self.learner.samples / 1e6,
                self.config.million_samples,
            ),
        )
        return [pair for pair in spent if pair[1] > 0]

    def _is_over(self, done: int, iterations: int | None) -> bool:
        """Return whether some process is to stop; all have to at once."""
        mine = self._signals.asked or self.progress >= 1.0 or (iterations is not None and done >= iterations)
        return self.learner.world.any([mine])[0]

    def _iterate(self) -> IterationReport:
        began = self._clock()
        try:
            # the schedule of the noise has to be the same in all processes
            progress = self.learner.world.mean(self.progress)
            report = self.learner.iterate(progress)
        except NotFiniteError as error:
            raise UniconError(self._keep_bad_batch(error)) from error
        self.seconds += self._clock() - began
        return report

    def _save_and_evaluate(self, log: MetricsLog | None) -> None:
        """Do what is due, in all processes alike."""
        config = self.config
        save = self.seconds - self._last_checkpoint_s >= config.checkpoint_minutes * 60.0
        judge = config.evaluate_minutes > 0
        judge = judge and self.seconds - self._last_evaluation_s >= config.evaluate_minutes * 60.0
        save, judge = self.learner.world.any([save, judge])
        if save:
            self._save()
        if judge:
            self._judge(log)

    def _save(self) -> None:
        if self._saved_iteration == self.learner.iteration:
            return
        write_checkpoint(self.folder, self.learner, self.seconds, self.config.checkpoints_kept)
        self._saved_iteration = self.learner.iteration
        self._last_checkpoint_s = self.seconds

    def _judge(self, log: MetricsLog | None) -> None:
        """Evaluate in the leading process, while the others wait."""
        if self._evaluate is not None and log is not None:
            scores = {f"evaluation/{name}": value for name, value in self._evaluate(self.learner).items()}
            log.write(self.learner.iteration, scores)
            shown = ", ".join(
                f"{name.split('/')[-1]} {value:.3f}" for name, value in list(scores.items())[:4]
            )
            self.console.print(f"evaluation at {self.seconds / 60.0:.1f} min: {shown}", soft_wrap=True)
        self.learner.world.wait()
        self._last_evaluation_s = self.seconds

    def _keep_bad_batch(self, error: NotFiniteError) -> str:
        """Save what was learned from; return the sentence for the user."""
        path = self.folder / BAD_BATCH_FILE
        saved = "there was no batch to save"
        if error.batch is not None:
            tensors = {name: t.detach().cpu().contiguous() for name, t in error.batch._asdict().items()}
            try:
                save_file(tensors, path)
                saved = f"the batch is in {path}"
            except (OSError, SafetensorError) as unwritable:
                saved = f"the batch could not be saved ({unwritable})"
        found = checkpoints_of(self.folder)
        last = f"the last good checkpoint is {found[-1]}" if found else "there is no checkpoint yet"
        return f"iteration {self.learner.iteration + 1}: {error} is not finite; {saved}; {last}"
