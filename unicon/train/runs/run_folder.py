"""The folder of a training run: what was asked for, by which command, from which commit.

``config.yaml`` has every setting, ``starts.jsonl`` one line for each time the run was started.
"""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import torch

import unicon
from unicon.errors import InputFileError, UniconError
from unicon.train.runs.checkpoint import checkpoints_of
from unicon.train.runs.recipe import Recipe, recipe_text

CONFIG_FILE, STARTS_FILE = "config.yaml", "starts.jsonl"


@dataclass(frozen=True)
class RunFolder:
    """A run on disk."""

    path: Path

    @property
    def config(self) -> Path:
        """Every setting."""
        return self.path / CONFIG_FILE

    @property
    def checkpoint(self) -> Path | None:
        """The newest checkpoint, if there is one."""
        found = checkpoints_of(self.path)
        return found[-1] if found else None


def run_of(path: Path) -> Path:
    """Return the folder of a run, given that or one of its checkpoints.

    Raises:
        InputFileError: when it is neither.
    """
    for folder in (path, *path.resolve().parents[1:2]):
        if (folder / CONFIG_FILE).is_file():
            return folder
    raise InputFileError(
        f"{path}: holds no {CONFIG_FILE}; expected the folder of a training run or of a checkpoint"
    )


def open_run(path: Path, recipe: Recipe, resume: bool) -> RunFolder:
    """Make the folder of a new run, or open that of one to go on with, and note the start.

    Raises:
        UniconError: when a new run finds another there, or one to go on with is not there.
    """
    folder = RunFolder(path)
    if resume and folder.checkpoint is None:
        raise UniconError(f"{path}: holds no checkpoint to go on from; leave out --resume to begin there")
    if not resume and (folder.config.exists() or folder.checkpoint):
        raise UniconError(f"{path}: holds a run already; go on with it by --resume, or give another --out")
    try:
        path.mkdir(parents=True, exist_ok=True)
        folder.config.write_text(recipe_text(recipe), encoding="utf-8")
        with (path / STARTS_FILE).open("a", encoding="utf-8") as file:
            file.write(json.dumps(_start(recipe, folder.checkpoint)) + "\n")
    except OSError as error:
        raise UniconError(f"{path}: the run cannot be written there ({error.strerror})") from error
    return folder


def git_commit() -> str | None:
    """Return the commit of this program, with a + where files differ from it; None outside a clone."""
    root = Path(unicon.__file__).parents[1]
    try:
        command = ["git", "-C", str(root), "describe", "--always", "--abbrev=40", "--exclude=*", "--dirty=+"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() or None if done.returncode == 0 else None


def _start(recipe: Recipe, checkpoint: Path | None) -> dict[str, object]:
    return {
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": shlex.join(sys.argv),
        "commit": git_commit(),
        "seed": recipe.learner.seed,
        "from": checkpoint.name if checkpoint else None,
        "unicon": unicon.__version__,
        "torch": torch.__version__,
    }
