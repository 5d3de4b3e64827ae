"""The loop of a network's training: learn, judge, log, save, until the budget is spent or Ctrl-C."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Literal

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

from unicon.errors import UniconError
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
from unicon.schedulers.pfnn.network_file import WEIGHTS_FILE, save_network
from unicon.train.pfnn.network_model_card import model_card
from unicon.train.pfnn.training import NetworkError, NetworkTrainer
from unicon.train.pfnn.training_plots import PLOT_FILE, draw_training
from unicon.train.pfnn.training_state import STATE_FILE, read_state, write_state
from unicon.train.runs.metrics_log import MetricsLog
from unicon.train.runs.state_file import write_in_one_step
from unicon.train.runs.stop_signals import StopSignals

NETWORK_FOLDER = "pfnn"
"""Within the folder of a run: the network with its card and plot, as a folder of ``policies/`` holds it."""
_CHUNK = 25
Describe = Callable[[NetworkError, float], PhaseNetworkCard]
"""Returns the card of a network with this error after so many seconds of training."""


class NetworkTrainingRun:
    """A trainer at work in the folder of a run."""

    def __init__(self, trainer: NetworkTrainer, folder: Path, console: Console, describe: Describe) -> None:
        """Begin, or go on from where the folder says.

        Raises:
            InputFileError: when what the folder holds cannot be gone on from.
        """
        self.trainer, self.folder, self.console = trainer, folder, console
        self.seconds = 0.0
        """Spent training, judging left out."""
        self._describe = describe
        if (folder / STATE_FILE).is_file():
            self.seconds = read_state(folder / STATE_FILE, trainer).seconds
        self._judged_at_s = self.seconds

    @property
    def network_folder(self) -> Path:
        """Where the network lies with its card and plot."""
        return self.folder / NETWORK_FOLDER

    @property
    def progress(self) -> float:
        """Share of the budget that is spent, 0 where there is none."""
        config = self.trainer.config
        budgets = ((self.seconds / 60.0, config.minutes), (self.trainer.steps, config.steps))
        return min(1.0, max((spent / budget for spent, budget in budgets if budget), default=0.0))

    def train(self) -> Literal["finished", "stopped"]:
        """Train until the budget is spent, or SIGINT or SIGTERM comes; all is saved in any case.

        Raises:
            UniconError: when the loss is not finite, or something cannot be written.
        """
        log = MetricsLog(self.folder, self.trainer.steps, tensorboard=False)
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeRemainingColumn(),
        )
        try:
            with StopSignals() as stop, Progress(*columns, console=self.console) as bar:
                task = bar.add_task("training", total=1.0)
                while self.progress < 1.0 and not stop.asked:
                    loss = self._learn(stop)
                    bar.update(task, completed=self.progress)
                    if self.seconds - self._judged_at_s >= self.trainer.config.judge_seconds:
                        self._judge(loss, log, bar, task)
                self._judge(math.nan, log, bar, task)
        finally:
            log.close()
        return "finished" if self.progress >= 1.0 else "stopped"

    def _learn(self, stop: StopSignals) -> float:
        """Do some steps; return their mean loss."""
        began, losses = time.monotonic(), []
        steps, budget = self.trainer.steps, self.trainer.config.steps
        for _ in range(min(_CHUNK, budget - steps) if budget else _CHUNK):
            losses.append(self.trainer.step(self.progress))
            if stop.asked:
                break
        loss = float(sum(losses) / len(losses))
        self.seconds += time.monotonic() - began
        if not math.isfinite(loss):
            raise UniconError(
                f"step {self.trainer.steps}: the loss is not finite; what was saved last is in "
                f"{self.folder}; go on from it with a smaller learning_rate"
            )
        return loss

    def _judge(self, loss: float, log: MetricsLog, bar: Progress, task: TaskID) -> None:
        """Judge the network, log it and save all."""
        self._judged_at_s = self.seconds
        trainer = self.trainer
        held_out, learned = trainer.judge(), trainer.judge_learned()
        row = {
            "time/seconds": round(self.seconds, 3),
            "loss/held_out": held_out.loss,
            "loss/learned": learned.loss,
            **({"loss/training": loss} if math.isfinite(loss) else {}),
            **{f"held_out/{name}": value for name, value in held_out.parts.items()},
            **{f"share/{name}": value for name, value in held_out.shares.items()},
            "learning_rate": trainer.learning_rate(self.progress),
        }
        log.write(trainer.steps, row)
        self._save(held_out)
        line = f"held-out loss {held_out.loss:.4f}, learned {learned.loss:.4f}"
        bar.update(task, description=line)
        minutes = self.seconds / 60.0
        bar.console.print(f"{minutes:.1f} min, {trainer.steps} steps: {line}", highlight=False)

    def _save(self, error: NetworkError) -> None:
        """Write the state, and the network with its card and plot."""
        write_state(self.folder / STATE_FILE, self.trainer, self.seconds)
        out = self.network_folder
        card = self._describe(error, self.seconds)
        card = save_network(out / WEIGHTS_FILE, card, self.trainer.network.export())
        write_in_one_step(out / "README.md", model_card(card))
        draw_training(self.folder, out / PLOT_FILE)
