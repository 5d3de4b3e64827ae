"""Where a network's training stands: one file, from which it goes on to the bit; nothing is unpickled.

``state.safetensors`` holds weights, normalisation, Adam's moments and the state of the draws; its metadata
the steps and seconds. The file changes all at once.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save_file
from torch import Tensor

from unicon.errors import InputFileError, UniconError
from unicon.train.pfnn.training import NetworkTrainer

STATE_FILE = "state.safetensors"
FORMAT = "unicon phase network training 1"
_NETWORK = "network."
_MOMENTS = ("step", "exp_avg", "exp_avg_sq")


class TrainingNumbers(NamedTuple):
    """What is spent."""

    steps: int
    seconds: float
    """Judging left out."""


def write_state(path: Path, trainer: NetworkTrainer, seconds: float) -> None:
    """Write where a training stands.

    Raises:
        UniconError: when it cannot be written, e.g. as the disk is full; the old file stays.
    """
    part = path.with_name(f".{path.name}.part")
    metadata = {"format": FORMAT, "steps": str(trainer.steps), "seconds": repr(seconds)}
    try:
        save_file(_tensors_of(trainer), part, metadata)
        with part.open("rb") as file:
            os.fsync(file.fileno())
        part.replace(path)
    except (OSError, SafetensorError) as error:
        part.unlink(missing_ok=True)
        reason = getattr(error, "strerror", None) or str(error)
        raise UniconError(f"{path}: cannot be written ({reason}); make room and go on") from error


def read_state(path: Path, trainer: NetworkTrainer) -> TrainingNumbers:
    """Bring a trainer to where a training stood.

    Raises:
        InputFileError: when the file is damaged, or of a network of other sizes.
    """
    try:
        with safe_open(path, "pt") as file:
            metadata = file.metadata() or {}
        tensors = load_file(path)
    except (OSError, SafetensorError) as error:
        raise InputFileError(f"{path}: cannot be read as safetensors ({error})") from error
    if metadata.get("format") != FORMAT:
        raise InputFileError(f"{path}: has the format {metadata.get('format')!r}, expected {FORMAT!r}")
    numbers = _read_numbers(path, metadata)
    expected = {name: tuple(tensor.shape) for name, tensor in trainer.network.state_dict().items()}
    found = {k.removeprefix(_NETWORK): tuple(v.shape) for k, v in tensors.items() if k.startswith(_NETWORK)}
    missing = [name for name in _names_of_moments(trainer) if name not in tensors]
    if found != expected or missing or "generator" not in tensors:
        raise InputFileError(
            f"{path}: is not of a network of these sizes; go on with the settings and the "
            "program that wrote it"
        )
    _restore(tensors, trainer)
    trainer.steps = numbers.steps
    return numbers


def _tensors_of(trainer: NetworkTrainer) -> dict[str, Tensor]:
    tensors = {f"{_NETWORK}{name}": value for name, value in trainer.network.state_dict().items()}
    for name, parameter in trainer.network.named_parameters():
        for kind, moment in trainer.optimizer.state.get(parameter, {}).items():
            tensors[f"adam.{kind}.{name}"] = moment
    tensors["generator"] = trainer.generator.get_state()
    return {name: value.detach().contiguous() for name, value in tensors.items()}


def _names_of_moments(trainer: NetworkTrainer) -> list[str]:
    return [f"adam.{kind}.{name}" for name, _ in trainer.network.named_parameters() for kind in _MOMENTS]


def _restore(tensors: dict[str, Tensor], trainer: NetworkTrainer) -> None:
    network = {k.removeprefix(_NETWORK): v for k, v in tensors.items() if k.startswith(_NETWORK)}
    trainer.network.load_state_dict(network)
    for name, parameter in trainer.network.named_parameters():
        trainer.optimizer.state[parameter] = {kind: tensors[f"adam.{kind}.{name}"] for kind in _MOMENTS}
    trainer.generator.set_state(tensors["generator"])


def _read_numbers(path: Path, metadata: dict[str, str]) -> TrainingNumbers:
    try:
        return TrainingNumbers(int(metadata["steps"]), float(metadata["seconds"]))
    except (KeyError, ValueError) as error:
        raise InputFileError(f"{path}: its steps and seconds cannot be read ({error})") from error
