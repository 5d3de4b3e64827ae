"""Exports a policy into its folder ``policies/<name>/``, and keeps what stands there in agreement.

    policy.safetensors, policy.json   weights and card; all that the executor needs
    policy.onnx                       the same network for other engines, its normalisation inside
    evaluation.json, robustness.json  its scores, as `unicon evaluate` and `unicon robustness` write them
    README.md                         the model card, made of all these

The network in ONNX: input ``observation (N, in)`` float32, raw; output ``action (N, 35)`` in shares of the
effort factors. What the outputs do to the joints is in its metadata: `unicon.policy.NetworkPolicy`.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from unicon.errors import InputFileError, UniconError
from unicon.policy_file import INPUT_CLIP, PolicyCard, PolicyWeights, read_policy, save_policy, write_card
from unicon.train.scoring.model_card import model_card

ONNX_FILE, README_FILE = "policy.onnx", "README.md"
EVALUATION_FILE, ROBUSTNESS_FILE = "evaluation.json", "robustness.json"
OPSET, IR_VERSION = 17, 8
"""Old enough for any engine of the last years."""


def export_policy(folder: Path, card: PolicyCard, weights: PolicyWeights) -> None:
    """Write a policy into its folder, and read it back as the executor does.

    Raises:
        UniconError: when the package onnx is missing, or the folder cannot be written.
        PolicyMismatchError: when card and weights do not belong together.
    """
    try:
        save_policy(folder, card, weights)
        written, weights = read_policy(folder)
        write_onnx(folder / ONNX_FILE, written, weights)
    except OSError as error:
        raise UniconError(f"{folder}: cannot be written ({error.strerror}); choose another folder") from error
    take_in_scores(folder)


def take_in_scores(folder: Path) -> PolicyCard:
    """Write the scores of evaluation.json and robustness.json into the card, and the model card anew.

    Raises:
        InputFileError: when a file is damaged.
    """
    card, weights = read_policy(folder)
    evaluation, robustness = (_read_json(folder / name) for name in (EVALUATION_FILE, ROBUSTNESS_FILE))
    scores = {} if evaluation is None else _figures(evaluation["all"])
    for trial in robustness["trials"] if robustness else ():
        if trial["relative_reward"] is not None:
            scores[f"relative reward, {trial['name']}"] = trial["relative_reward"]
    card = replace(card, scores=scores)
    write_card(folder, card)
    (folder / README_FILE).write_text(model_card(card, weights, evaluation, robustness), encoding="utf-8")
    return card


def write_onnx(path: Path, card: PolicyCard, weights: PolicyWeights) -> None:
    """Write the network as ONNX.

    Raises:
        UniconError: when the package onnx is missing.
    """
    try:
        import onnx
    except ImportError:
        raise UniconError(
            "export to ONNX needs the package onnx; install it with `pip install -r requirements/train.txt`"
        ) from None
    helper, floats = onnx.helper, onnx.TensorProto.FLOAT
    steps = list(_steps(card, weights))
    constants = {name: value for _, _, values in steps for name, value in values.items()}
    graph = helper.make_graph(
        [helper.make_node(kind, *ends) for kind, ends, _ in steps],
        card.name,
        [helper.make_tensor_value_info("observation", floats, ["N", weights.sizes[0]])],
        [helper.make_tensor_value_info("action", floats, ["N", weights.sizes[-1]])],
        [onnx.numpy_helper.from_array(value, name) for name, value in constants.items()],
    )
    opsets = [helper.make_opsetid("", OPSET)]
    model = helper.make_model(graph, opset_imports=opsets, producer_name="unicon", ir_version=IR_VERSION)
    helper.set_model_props(model, _metadata(card))
    onnx.checker.check_model(model, full_check=True)
    path.write_bytes(model.SerializeToString())


Step = tuple[str, tuple[list[str], list[str]], dict[str, np.ndarray]]
"""An operation, its inputs and outputs, and the constants among its inputs."""


def _steps(card: PolicyCard, weights: PolicyWeights) -> Iterator[Step]:
    """Yield the operations from the raw observation to the action."""
    limits = {"low": np.float32(-INPUT_CLIP), "high": np.float32(INPUT_CLIP)}
    yield "Sub", (["observation", "input.mean"], ["centred"]), {"input.mean": weights.mean}
    yield "Div", (["centred", "input.std"], ["scaled"]), {"input.std": weights.std}
    yield "Clip", (["scaled", "low", "high"], ["x0"]), {k: np.asarray(v) for k, v in limits.items()}
    last = len(weights.layers) - 1
    for index, (weight, bias) in enumerate(weights.layers):
        names = f"layers.{index}.weight_t", f"layers.{index}.bias"
        out = "action" if index == last else f"y{index}"
        constants = dict(zip(names, (np.ascontiguousarray(weight.T), bias), strict=True))
        yield "Gemm", ([f"x{index}", *names], [out]), constants
        if index != last:
            yield from _activation(card.activation, out, f"x{index + 1}")


def _activation(name: str, before: str, after: str) -> Iterator[Step]:
    if name == "silu":
        yield "Sigmoid", ([before], [f"{before}.gate"]), {}
        yield "Mul", ([before, f"{before}.gate"], [after]), {}
    else:
        yield {"relu": "Relu", "elu": "Elu", "tanh": "Tanh"}[name], ([before], [after]), {}


def _metadata(card: PolicyCard) -> dict[str, str]:
    ahead = ",".join(str(ticks) for ticks in card.frames_ahead)
    names = ("name", "humanoid_id", "observation_id", "action", "control_hz", "past", "training_data")
    return {**{name: str(getattr(card, name)) for name in names}, "future_ticks": ahead}


def _figures(values: dict[str, Any]) -> dict[str, float]:
    return {name: value for name, value in values.items() if isinstance(value, (int, float))}


def _read_json(path: Path) -> dict[str, Any] | None:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise InputFileError(
            f"{path}: cannot be read ({error}); run the command that makes it again"
        ) from error
