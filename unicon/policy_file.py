"""Policies on disk: ``policies/<name>/policy.json`` (the card) and ``policy.safetensors`` (the numbers).

Tensors: ``layers.<i>.weight (out, in)``, ``layers.<i>.bias (out,)`` and the normalisation of the input
``input.mean (in,)``, ``input.std (in,)``. Nothing is ever unpickled. The card holds the output for a fixed
input, which is computed again on loading: damaged or mixed-up files are refused.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load_file, save_file

from unicon.errors import InputFileError, UniconError
from unicon.humanoid import HUMANOID
from unicon.observation import MAX_TAU, OBSERVATION_ID, OBSERVATION_SIZE, policy_input_size

FORMAT = 1
CARD_FILE, WEIGHTS_FILE = "policy.json", "policy.safetensors"
SELF_CHECK_TOLERANCE = 1e-4
INPUT_CLIP = 5.0
CONTROL_HZ = 60
MAX_AHEAD = 240
MAX_PAST = 8

ACTIVATIONS = {
    "relu": lambda x: np.maximum(x, 0.0),
    "elu": lambda x: np.where(x > 0, x, np.expm1(np.minimum(x, 0.0))),
    "silu": lambda x: x / (1.0 + np.exp(-x)),
    "tanh": np.tanh,
}


class PolicyMismatchError(UniconError):
    """A policy was made for another humanoid, another observation or another size."""


@dataclass(frozen=True)
class PolicyCard:
    """What a policy is, and what it was made for."""

    name: str
    description: str
    humanoid_id: str
    observation_id: str
    tau: int
    """How many target frames it looks at, 1 to 8."""
    control_hz: int
    """How often a second it is asked: 60."""
    action: Literal["torque", "torque-servo", "pd"]
    """What its outputs do; see `unicon.policy.NetworkPolicy`."""
    activation: Literal["relu", "elu", "silu", "tanh"]
    training_data: str
    """What it was trained on, with the licences."""
    future: tuple[int, ...] = ()
    """Which target frames it looks at, in ticks of 1/60 s from the present; empty: the next ``tau``."""
    past: int = 0
    """How many of the avatar's own last states it sees besides."""
    training: str = ""
    """How it was trained: recipe, action mode, control rate, hours, samples."""
    scores: Mapping[str, float] = field(default_factory=dict)
    """Its figures of merit by name, as in evaluation.json and robustness.json."""
    network: tuple[int, ...] = ()
    """Size of the input, then the outputs of each layer; written on saving."""
    self_check: tuple[float, ...] = ()
    """Its 35 outputs for the input of `self_check_input`; written on saving."""
    format: int = FORMAT

    @property
    def frames_ahead(self) -> tuple[int, ...]:
        """The target frames it looks at, in ticks from the present."""
        return self.future or tuple(range(1, self.tau + 1))

    @property
    def input_size(self) -> int:
        """Length of the network's input: s_t, then o of each past state."""
        return policy_input_size(self.tau) + self.past * OBSERVATION_SIZE


@dataclass(frozen=True)
class PolicyWeights:
    """A multi-layer perceptron in float32."""

    layers: tuple[tuple[np.ndarray, np.ndarray], ...]
    """Weight ``(out, in)`` and bias ``(out,)`` of each layer."""
    mean: np.ndarray
    std: np.ndarray

    @property
    def sizes(self) -> tuple[int, ...]:
        """Input size, then the output size of each layer."""
        return (self.layers[0][0].shape[1], *(weight.shape[0] for weight, _ in self.layers))

    def evaluate(self, seen: np.ndarray, activation: str) -> np.ndarray:
        """Return the outputs ``(..., 35)`` for inputs ``(..., in)``, normalised and cut off at 5 sigma.

        The products are those of one input at a time: what it gives does not depend on its neighbours, to
        the bit.
        """
        x = np.clip((seen.astype(np.float32) - self.mean) / self.std, -INPUT_CLIP, INPUT_CLIP)
        function = ACTIVATIONS[activation]
        for weight, bias in self.layers[:-1]:
            x = function(_multiply(weight, x) + bias)
        weight, bias = self.layers[-1]
        return (_multiply(weight, x) + bias).astype(np.float64)


def _multiply(weight: np.ndarray, x: np.ndarray) -> np.ndarray:
    return (weight @ x[..., None])[..., 0]


def self_check_input(size: int) -> np.ndarray:
    """Return the fixed input ``(size,)`` whose output the card holds: a wave, the same everywhere."""
    return np.sin(np.arange(size) * 0.7)


def save_policy(folder: Path, card: PolicyCard, weights: PolicyWeights) -> None:
    """Write a policy, with the self-check computed now.

    Raises:
        PolicyMismatchError: when card and weights do not belong together; nothing is written then.
    """
    outputs = weights.evaluate(self_check_input(weights.sizes[0]), card.activation)
    check = tuple(float(v) for v in outputs)
    card = dataclasses.replace(card, network=weights.sizes, self_check=check)
    _check_fit(folder, card, weights)
    write_card(folder, card)
    tensors = {"input.mean": weights.mean, "input.std": weights.std}
    for index, (weight, bias) in enumerate(weights.layers):
        tensors[f"layers.{index}.weight"], tensors[f"layers.{index}.bias"] = weight, bias
    save_file(
        {k: np.ascontiguousarray(v, dtype=np.float32) for k, v in tensors.items()},
        folder / WEIGHTS_FILE,
    )


def write_card(folder: Path, card: PolicyCard) -> None:
    """Write the card alone."""
    folder.mkdir(parents=True, exist_ok=True)
    values = {**vars(card), "scores": dict(card.scores)}
    (folder / CARD_FILE).write_text(json.dumps(values, indent=2) + "\n")


def read_policy(folder: Path) -> tuple[PolicyCard, PolicyWeights]:
    """Read a policy and check that it fits this humanoid and observation.

    Raises:
        InputFileError: when a file is missing, damaged or says something else than it should.
        PolicyMismatchError: when it was made for something else; the message has both sides.
    """
    card = _read_card(folder / CARD_FILE)
    weights = _read_weights(folder / WEIGHTS_FILE)
    _check_fit(folder, card, weights)
    outputs = weights.evaluate(self_check_input(card.input_size), card.activation)
    difference = np.abs(outputs - np.array(card.self_check)).max()
    if not difference <= SELF_CHECK_TOLERANCE:
        raise InputFileError(
            f"{folder}: the outputs for the self-check differ from the card's by {difference:.2g}: "
            f"{WEIGHTS_FILE} and {CARD_FILE} do not belong together; export the policy again"
        )
    return card, weights


def _read_card(path: Path) -> PolicyCard:
    try:
        values = json.loads(path.read_text())
    except OSError as error:
        raise InputFileError(f"{path}: cannot be read ({error.strerror}); a policy needs it") from error
    except ValueError as error:
        raise InputFileError(f"{path}: is not JSON ({error}); export the policy again") from error
    if not isinstance(values, dict):
        raise InputFileError(f"{path}: expected a JSON object, got {type(values).__name__}")
    known = dataclasses.fields(PolicyCard)
    for part in known:
        _check_field(path, part, values)
    unknown = set(values) - {part.name for part in known}
    if unknown:
        raise InputFileError(f"{path}: unknown field {sorted(unknown)[0]!r}; is it of a newer version?")
    lists = {name: tuple(value) for name, value in values.items() if isinstance(value, list)}
    card = PolicyCard(**{**values, **lists})
    _check_frames(path, card)
    return card


_JSON_TYPES: dict[str, type] = {
    "int": int,
    "str": str,
    "tuple[int, ...]": list,
    "tuple[float, ...]": list,
    "Mapping[str, float]": dict,
}
_CHOICES = {
    "control_hz": (CONTROL_HZ,),
    "action": ("torque", "torque-servo", "pd"),
    "activation": tuple(ACTIVATIONS),
    "format": (FORMAT,),
}


def _check_field(path: Path, part: dataclasses.Field[Any], values: dict[str, Any]) -> None:
    if part.name not in values:
        if part.name in ("future", "past", "training", "scores", "network"):
            return
        raise InputFileError(f"{path}: the field {part.name!r} is missing")
    value, expected = values[part.name], _JSON_TYPES.get(str(part.type), str)
    if not isinstance(value, expected) or isinstance(value, bool):
        kind = type(value).__name__
        raise InputFileError(f"{path}: {part.name!r} is a {kind}, expected {expected.__name__}")
    choices = _CHOICES.get(part.name)
    if choices and value not in choices:
        raise InputFileError(f"{path}: {part.name!r} is {value!r}, expected one of {choices}")
    if part.name == "tau" and not 1 <= value <= MAX_TAU:
        raise InputFileError(f"{path}: 'tau' is {value}, expected 1 to {MAX_TAU}")
    if isinstance(value, list) and not all(isinstance(v, (int, float)) for v in value):
        raise InputFileError(f"{path}: {part.name!r} holds something that is not a number")


def _check_frames(path: Path, card: PolicyCard) -> None:
    whole = all(isinstance(ticks, int) and 0 <= ticks <= MAX_AHEAD for ticks in card.frames_ahead)
    if len(card.frames_ahead) != card.tau or not whole:
        raise InputFileError(
            f"{path}: 'future' is {list(card.future)}, expected {card.tau} whole numbers ('tau') of 0 to "
            f"{MAX_AHEAD} ticks"
        )
    if not 0 <= card.past <= MAX_PAST:
        raise InputFileError(f"{path}: 'past' is {card.past}, expected 0 to {MAX_PAST}")


def _read_weights(path: Path) -> PolicyWeights:
    try:
        tensors = load_file(path)
    except (OSError, SafetensorError) as error:
        raise InputFileError(f"{path}: cannot be read as safetensors ({error})") from error
    try:
        count = sum(name.endswith(".weight") for name in tensors)
        layers = tuple((tensors[f"layers.{i}.weight"], tensors[f"layers.{i}.bias"]) for i in range(count))
        weights = PolicyWeights(layers, tensors["input.mean"], tensors["input.std"])
    except KeyError as error:
        raise InputFileError(f"{path}: the tensor {error} is missing; export the policy again") from error
    if not layers or not all(np.isfinite(t).all() for t in tensors.values()) or (weights.std <= 0).any():
        raise InputFileError(f"{path}: holds no layers, or numbers that are not finite; export it again")
    return weights


def _check_fit(folder: Path, card: PolicyCard, weights: PolicyWeights) -> None:
    for what, made_for, here in (
        ("humanoid", card.humanoid_id, HUMANOID.id),
        ("observation", card.observation_id, OBSERVATION_ID),
    ):
        if made_for != here:
            raise PolicyMismatchError(f"{folder}: made for the {what} {made_for}, this is {here}")
    expected = (card.input_size, len(HUMANOID.joint_names))
    shapes = weights.sizes
    chained = all(
        weight.ndim == 2 and weight.shape == (shapes[i + 1], shapes[i]) and bias.shape == (shapes[i + 1],)
        for i, (weight, bias) in enumerate(weights.layers)
    )
    if (shapes[0], shapes[-1]) != expected or not chained or weights.mean.shape != weights.std.shape:
        raise PolicyMismatchError(
            f"{folder}: its layers have the sizes {shapes}, expected {expected[0]} inputs and "
            f"{expected[1]} outputs"
        )
    if weights.mean.shape != (expected[0],) or len(card.self_check) != expected[1]:
        raise PolicyMismatchError(f"{folder}: its normalisation or self-check has the wrong length")
