"""The settings of a network's training in the folder of its run: config.yaml."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

import yaml

from unicon.errors import InputFileError, UniconError
from unicon.train.pfnn.training_state import STATE_FILE
from unicon.train.runs.run_folder import CONFIG_FILE as SETTINGS_FILE
from unicon.train.runs.settings import build, plain

T = TypeVar("T")


def save_settings(folder: Path, settings: Any, resume: bool) -> None:
    """Write the settings into the folder of a run.

    Raises:
        UniconError: when a new run finds another there, one to go on with is not, or it can't be written.
    """
    if resume and not (folder / STATE_FILE).is_file():
        raise UniconError(f"{folder}: holds no {STATE_FILE} to go on from; leave out --resume to begin there")
    if not resume and (folder / STATE_FILE).is_file():
        raise UniconError(f"{folder}: holds a run already; go on with it by --resume, or give another --out")
    text = yaml.safe_dump(plain(settings), sort_keys=False, width=110)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / SETTINGS_FILE).write_text(text, encoding="utf-8")
    except OSError as error:
        raise UniconError(f"{folder}: the run cannot be written there ({error.strerror})") from error


def open_settings(folder: Path, kind: type[T]) -> T:
    """Read the settings of a run.

    Args:
        folder: of the run.
        kind: their dataclass.

    Raises:
        InputFileError: when they are missing, damaged or say what is no setting.
    """
    file = folder / SETTINGS_FILE
    try:
        values = yaml.safe_load(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "is no text"
        raise InputFileError(
            f"{file}: cannot be read ({reason}); leave out --resume to begin there"
        ) from error
    except yaml.YAMLError as error:
        raise InputFileError(f"{file}: is not YAML ({' '.join(str(error).split())})") from error
    return build(kind, values, str(file))
