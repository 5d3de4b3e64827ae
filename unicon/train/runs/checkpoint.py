"""Checkpoints: all that a training needs to go on to the bit, in safetensors and JSON; nothing is unpickled.

``checkpoints/00000120/`` holds ``learner.safetensors`` (networks, normalisation, Adam's moments),
``process_<rank>.safetensors`` (noise generator, observations and environments of each process) and
``checkpoint.json``. A folder appears under its name only when all of it is on the disk.
"""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from unicon.errors import InputFileError, UniconError
from unicon.train.learning.learner import Learner
from unicon.train.learning.networks import ActorCritic

FORMAT = 1
NUMBERS_FILE, LEARNER_FILE = "checkpoint.json", "learner.safetensors"
_NETWORK, _ENVIRONMENT = "network.", "environment."
_MOMENTS = ("step", "exp_avg", "exp_avg_sq")


@dataclass(frozen=True)
class CheckpointNumbers:
    """The content of ``checkpoint.json``."""

    iteration: int
    samples: int
    """Of all processes."""
    seconds: float
    """Spent training, evaluations left out."""
    learning_rate: float
    kl_penalty: float
    processes: int
    format: int = FORMAT


def checkpoints_of(folder: Path) -> list[Path]:
    """Return the complete checkpoints of a run, oldest first."""
    return sorted(path for path in (folder / "checkpoints").glob("[0-9]*") if (path / NUMBERS_FILE).is_file())


def write_checkpoint(folder: Path, learner: Learner, seconds: float, keep: int) -> Path:
    """Write a checkpoint of a run in one step and remove old ones; every process calls it.

    Args:
        folder: of the run.
        learner: what to save.
        seconds: time spent training.
        keep: how many of the newest stay.

    Raises:
        UniconError: when it cannot be written, e.g. as the disk is full; those before it stay.
    """
    world = learner.world
    final = folder / "checkpoints" / f"{learner.iteration:08d}"
    part = final.with_name(f".{final.name}.part")
    try:
        part.mkdir(parents=True, exist_ok=True)
        _save(_process_tensors(learner), part / _process_file(world.rank))
        if world.leads:
            _save(_learner_tensors(learner), part / LEARNER_FILE)
            (part / NUMBERS_FILE).write_text(json.dumps(asdict(_numbers(learner, seconds)), indent=2) + "\n")
    except (OSError, SafetensorError) as error:
        shutil.rmtree(part, ignore_errors=True)
        last = checkpoints_of(folder)
        kept = f"the last good checkpoint is {last[-1]}" if last else "there is no earlier one"
        raise UniconError(f"{final}: cannot be written ({_reason(error)}); {kept}") from error
    world.wait()
    if world.leads:
        shutil.rmtree(final, ignore_errors=True)
        part.rename(final)
        for old in checkpoints_of(folder)[:-keep]:
            shutil.rmtree(old, ignore_errors=True)
    return final


def write_networks(folder: Path, network: ActorCritic, numbers: CheckpointNumbers) -> Path:
    """Write a checkpoint with networks alone: who goes on from it begins new episodes.

    Raises:
        UniconError: when it cannot be written.
    """
    path = folder / "checkpoints" / f"{numbers.iteration:08d}"
    try:
        path.mkdir(parents=True)
        _save(_network_tensors(network), path / LEARNER_FILE)
        (path / NUMBERS_FILE).write_text(json.dumps(asdict(numbers), indent=2) + "\n")
    except (OSError, SafetensorError) as error:
        raise UniconError(f"{path}: cannot be written ({_reason(error)})") from error
    return path


def read_checkpoint(path: Path, learner: Learner) -> CheckpointNumbers:
    """Bring a learner to where a checkpoint was made.

    Processes that it does not know, as there are more now, begin new episodes.

    Raises:
        InputFileError: when the checkpoint is damaged or is of other networks.
    """
    numbers = read_numbers(path)
    tensors = _load(path / LEARNER_FILE)
    _restore_network(path, tensors, learner.network)
    for name, parameter in learner.network.named_parameters():
        moments = {kind: tensors.get(f"adam.{kind}.{name}") for kind in _MOMENTS}
        if None not in moments.values():
            learner.ppo.optimizer.state[parameter] = {
                kind: moment.to(parameter.device) for kind, moment in moments.items() if moment is not None
            }
    learner.ppo.learning_rate, learner.ppo.kl_penalty = numbers.learning_rate, numbers.kl_penalty
    learner.iteration, learner.samples = numbers.iteration, numbers.samples
    if (path / _process_file(learner.world.rank)).is_file():
        _restore_process(path, learner)
    return numbers


def read_networks(path: Path, network: ActorCritic) -> CheckpointNumbers:
    """Give a network the weights and the normalisation of a checkpoint; its noise stays its own.

    Args:
        path: a checkpoint, or a run's folder, whose newest checkpoint is taken.
        network: of the same sizes.

    Raises:
        InputFileError: when there is no checkpoint, it is damaged or of other networks.
    """
    if not (path / LEARNER_FILE).is_file():
        found = checkpoints_of(path)
        if not found:
            raise InputFileError(
                f"{path}: holds no checkpoint; expected the folder of a run or of a checkpoint"
            )
        path = found[-1]
    log_std = network.log_std.detach().clone()
    _restore_network(path, _load(path / LEARNER_FILE), network)
    network.log_std.data.copy_(log_std)
    return read_numbers(path)


def read_numbers(path: Path) -> CheckpointNumbers:
    """Return what ``checkpoint.json`` says.

    Raises:
        InputFileError: when it is damaged or of a newer version.
    """
    file = path / NUMBERS_FILE
    try:
        numbers = CheckpointNumbers(**json.loads(file.read_text()))
    except (OSError, ValueError, TypeError) as error:
        raise InputFileError(f"{file}: cannot be read as a checkpoint's numbers ({error})") from error
    if numbers.format != FORMAT:
        raise InputFileError(f"{file}: has the format {numbers.format}, this program reads {FORMAT}")
    return numbers


def _numbers(learner: Learner, seconds: float) -> CheckpointNumbers:
    return CheckpointNumbers(
        iteration=learner.iteration,
        samples=learner.samples,
        seconds=seconds,
        learning_rate=learner.ppo.learning_rate,
        kl_penalty=learner.ppo.kl_penalty,
        processes=learner.world.size,
    )


def _network_tensors(network: ActorCritic) -> dict[str, Tensor]:
    return {f"{_NETWORK}{name}": value for name, value in network.state_dict().items()}


def _learner_tensors(learner: Learner) -> dict[str, Tensor]:
    tensors = _network_tensors(learner.network)
    for name, parameter in learner.network.named_parameters():
        for kind, moment in learner.ppo.optimizer.state.get(parameter, {}).items():
            tensors[f"adam.{kind}.{name}"] = moment
    return tensors


def _process_tensors(learner: Learner) -> dict[str, Tensor]:
    tensors = {
        "generator": learner.generator.get_state(),
        "episode_lengths": torch.from_numpy(learner.episodes.lengths),
    }
    if learner.observation is not None:
        tensors["observation"] = torch.from_numpy(np.ascontiguousarray(learner.observation))
    for name, array in learner.environment.state().items():
        tensors[f"{_ENVIRONMENT}{name}"] = torch.from_numpy(np.array(array, order="C"))
    return tensors


def _restore_network(path: Path, tensors: dict[str, Tensor], network: ActorCritic) -> None:
    values = {k.removeprefix(_NETWORK): v for k, v in tensors.items() if k.startswith(_NETWORK)}
    expected = network.state_dict()
    if {k: v.shape for k, v in values.items()} != {k: v.shape for k, v in expected.items()}:
        sizes = [tuple(v.shape) for k, v in values.items() if k.startswith("actor") and k.endswith("weight")]
        wanted = [tuple(layer.weight.shape) for layer in network.actor.layers]
        raise InputFileError(
            f"{path}: its policy has layers of the sizes {sizes}, the recipe asks for {wanted}, "
            "or their critics differ; take the recipe it was made with"
        )
    network.load_state_dict(values)


def _restore_process(path: Path, learner: Learner) -> None:
    file = path / _process_file(learner.world.rank)
    tensors = _load(file)
    state = {
        k.removeprefix(_ENVIRONMENT): v.numpy() for k, v in tensors.items() if k.startswith(_ENVIRONMENT)
    }
    try:
        learner.environment.restore(state)
        learner.generator.set_state(tensors["generator"])
        learner.episodes.lengths[:] = tensors["episode_lengths"].numpy()
        observation = tensors.get("observation")
    except (KeyError, ValueError, RuntimeError) as error:
        raise InputFileError(f"{file}: does not fit these environments ({error})") from error
    learner.observation = None if observation is None else observation.numpy()


def _process_file(rank: int) -> str:
    return f"process_{rank}.safetensors"


def _save(tensors: dict[str, Tensor], path: Path) -> None:
    save_file({k: v.detach().cpu().contiguous() for k, v in tensors.items()}, path)
    with path.open("rb") as file:
        os.fsync(file.fileno())


def _load(path: Path) -> dict[str, Tensor]:
    try:
        return load_file(path)
    except (OSError, SafetensorError) as error:
        raise InputFileError(f"{path}: cannot be read as safetensors ({error})") from error


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
