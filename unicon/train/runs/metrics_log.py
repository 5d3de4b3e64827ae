"""The log of a run: one row an iteration, in ``metrics.jsonl`` and for TensorBoard."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from unicon.errors import UniconError
from unicon.train.learning.learner import IterationReport

METRICS_FILE, TENSORBOARD_FOLDER = "metrics.jsonl", "tensorboard"


class MetricsLog:
    """Writes rows; each is on its way to the disk when ``write`` returns."""

    def __init__(self, folder: Path, iteration: int = 0, tensorboard: bool = True) -> None:
        """Open the log, without the rows after an iteration, from which the run goes on.

        Raises:
            UniconError: when it cannot be written.
        """
        self._path = folder / METRICS_FILE
        self._board: Any = None
        try:
            kept = _rows_until(self._path, iteration)
            self._file = self._path.open("w", encoding="utf-8")
            self._file.writelines(kept)
            if tensorboard:
                self._board = _open_tensorboard(folder / TENSORBOARD_FOLDER, iteration)
        except OSError as error:
            raise self._unwritable(error) from error

    def write(self, iteration: int, row: Mapping[str, float]) -> None:
        """Append a row.

        Raises:
            UniconError: when it cannot be written, e.g. as the disk is full.
        """
        try:
            self._file.write(json.dumps({"iteration": iteration, **row}) + "\n")
            self._file.flush()
            if self._board is not None:
                for name, value in row.items():
                    self._board.add_scalar(name, value, iteration)
        except OSError as error:
            raise self._unwritable(error) from error

    def close(self) -> None:
        """Close the files; what a full disk does not take is lost."""
        for file in (self._file, self._board):
            try:
                if file is not None:
                    file.close()
            except OSError:
                pass

    def _unwritable(self, error: OSError) -> UniconError:
        return UniconError(f"{self._path}: the log cannot be written ({error.strerror or error})")


def row_of(report: IterationReport, seconds: float) -> dict[str, float]:
    """Return an iteration as a row; names before a slash are TensorBoard's groups."""
    episodes, update = report.episodes, report.update
    return {
        "time/samples": report.samples,
        "time/seconds": round(seconds, 3),
        "time/samples_per_s": report.new_samples / (report.collect_s + report.update_s),
        "time/collect_s": report.collect_s,
        "time/update_s": report.update_s,
        "reward/total": episodes.reward,
        **{f"reward/{name}": value for name, value in episodes.terms._asdict().items()},
        "episode/length": episodes.length,
        "episode/survival": episodes.survival,
        "policy/std": report.std,
        "policy/kl": update.kl,
        "policy/surrogate": update.surrogate,
        "policy/clipped": update.clipped,
        "value/loss": update.value_loss,
        "value/explained": report.explained,
        "update/learning_rate": update.learning_rate,
        "update/kl_penalty": update.kl_penalty,
        "update/gradient_norm": update.gradient_norm,
        "update/epochs": update.epochs,
    }


def _rows_until(path: Path, iteration: int) -> list[str]:
    """Return the lines of a log up to an iteration; one that a crash cut off ends it."""
    kept: list[str] = []
    if not path.is_file():
        return kept
    for line in path.read_text(encoding="utf-8").splitlines(keepends=True):
        try:
            if json.loads(line)["iteration"] > iteration:
                break
        except (ValueError, KeyError, TypeError):
            break
        kept.append(line)
    return kept


def _open_tensorboard(folder: Path, iteration: int) -> Any:
    """Return TensorBoard's writer, or None where it is not installed."""
    try:
        from torch.utils.tensorboard import SummaryWriter
    except ImportError:
        return None
    return SummaryWriter(str(folder), purge_step=iteration + 1 if iteration else None)
