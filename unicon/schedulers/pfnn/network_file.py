"""Phase networks on disk: ``policies/<name>/pfnn.safetensors`` (the numbers) and ``pfnn.json`` (the card).

Tensors, float32: ``layers.<i>.weight (K, out, in)``, ``layers.<i>.bias (K, out)`` at K phases, and the
normalisation ``input.mean (I,)``, ``input.std (I,)``, ``output.mean (O,)``, ``output.std (O,)``. Nothing is
ever unpickled. The card holds the output for a fixed input, which is computed again on loading.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load_file, save_file

from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.humanoid import HUMANOID
from unicon.policy_file import SELF_CHECK_TOLERANCE, PolicyMismatchError, self_check_input
from unicon.policy_library import policies_folder
from unicon.schedulers.pfnn.layout import LAYOUT_ID
from unicon.schedulers.pfnn.network import PhaseLayer, PhaseNetwork
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard, read_card, write_card

WEIGHTS_FILE = "pfnn.safetensors"
CHECK_PHASE = 1.0
"""Phase of the self-check [rad]."""
_NORMALIZATION = ("input.mean", "input.std", "output.mean", "output.std")


def card_file(weights_file: Path) -> Path:
    """Return where the card of a file of weights lies: beside it."""
    return weights_file.with_suffix(".json")


def save_network(path: Path, card: PhaseNetworkCard, network: PhaseNetwork) -> PhaseNetworkCard:
    """Write a network and its card, with the self-check computed now.

    Args:
        path: the file of the weights, *.safetensors.
        card: what it is; sizes, phases, interpolation and self-check are filled in.
        network: what to write.

    Returns:
        The card as it was written.

    Raises:
        UniconError: when it cannot be written, e.g. as the disk is full.
    """
    outputs = network.predict(self_check_input(network.sizes[0]), CHECK_PHASE)
    card = replace(
        card,
        sizes=network.sizes,
        phases=network.phases,
        interpolation=network.interpolation,
        self_check=tuple(float(value) for value in outputs),
    )
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        save_file(_tensors_of(network), part)
        part.replace(path)
        write_card(card_file(path), card)
    except (OSError, SafetensorError) as error:
        if part.is_file():
            part.unlink()
        reason = getattr(error, "strerror", None) or str(error)
        raise UniconError(f"{path}: the network cannot be written ({reason})") from error
    return card


def find_network(name: str) -> Path:
    """Return the file of the weights of a network, by the name of its policy folder, or a path.

    Raises:
        UnknownNameError: when there is none.
    """
    path = Path(name) if os.sep in name or name.endswith(".safetensors") else policies_folder() / name
    if path.is_dir():
        path = path / WEIGHTS_FILE
    if name and path.is_file():
        return path
    known = sorted(file.parent.name for file in policies_folder().glob(f"*/{WEIGHTS_FILE}"))
    there = f"there are {', '.join(known)}" if known else "make one with `unicon pfnn train`"
    raise UnknownNameError(f"there is no phase network {name!r} ({path}); {there}")


def read_network(path: Path, layout_id: str | None = LAYOUT_ID) -> tuple[PhaseNetworkCard, PhaseNetwork]:
    """Read a network and check that it is whole and fits.

    Args:
        path: the file of the weights, as `find_network` returns it.
        layout_id: what its input and output have to mean; None: whatever they do.

    Raises:
        InputFileError: when a file is missing, damaged or says something else than it should.
        PolicyMismatchError: when it was made for another layout or another humanoid.
    """
    card = read_card(card_file(path))
    if layout_id is not None:
        _check_fit(path, card, layout_id)
    network = _read_weights(path, card)
    if (network.sizes, network.phases) != (card.sizes, card.phases):
        raise InputFileError(
            f"{path}: has the sizes {network.sizes} at {network.phases} phases, its card says {card.sizes} "
            f"at {card.phases}; the two files do not belong together"
        )
    outputs = network.predict(self_check_input(network.sizes[0]), CHECK_PHASE)
    scale = np.maximum(1.0, np.abs(outputs))  # the original's outputs are in centimetres
    if len(card.self_check) != len(outputs):
        raise InputFileError(f"{card_file(path)}: 'self_check' has not one number for each output")
    difference = np.abs((outputs - np.array(card.self_check)) / scale).max()
    if not difference <= SELF_CHECK_TOLERANCE:
        raise InputFileError(
            f"{path}: the outputs for the self-check differ from the card's by {difference:.2g}: the two "
            "files do not belong together; write the network again"
        )
    return card, network


def _tensors_of(network: PhaseNetwork) -> dict[str, np.ndarray]:
    normalization = (network.input_mean, network.input_std, network.output_mean, network.output_std)
    tensors: dict[str, np.ndarray] = dict(zip(_NORMALIZATION, normalization, strict=True))
    for index, layer in enumerate(network.layers):
        tensors[f"layers.{index}.weight"], tensors[f"layers.{index}.bias"] = layer.weight, layer.bias
    return {name: np.ascontiguousarray(value, dtype=np.float32) for name, value in tensors.items()}


def _read_weights(path: Path, card: PhaseNetworkCard) -> PhaseNetwork:
    try:
        tensors = load_file(path)
    except (OSError, SafetensorError) as error:
        raise InputFileError(f"{path}: cannot be read as safetensors ({error})") from error
    try:
        count = sum(name.endswith(".weight") for name in tensors)
        pairs = [(tensors[f"layers.{i}.weight"], tensors[f"layers.{i}.bias"]) for i in range(count)]
        normalization = [tensors[name] for name in _NORMALIZATION]
    except KeyError as error:
        raise InputFileError(f"{path}: the tensor {error} is missing; write the network again") from error
    if not pairs or not all(np.isfinite(tensor).all() for tensor in tensors.values()):
        raise InputFileError(f"{path}: holds no layers, or numbers that are not finite; write it again")
    _check_shapes(path, pairs, normalization)
    layers = tuple(PhaseLayer(weight, bias) for weight, bias in pairs)
    return PhaseNetwork(layers, *normalization, card.interpolation)  # type: ignore[arg-type]


def _check_shapes(
    path: Path, pairs: list[tuple[np.ndarray, np.ndarray]], normalization: list[np.ndarray]
) -> None:
    """Raise InputFileError: when the layers do not follow on each other."""
    shapes = [weight.shape for weight, _ in pairs]
    fits = all(len(shape) == 3 for shape in shapes)
    fits = fits and len({shape[0] for shape in shapes}) == 1
    fits = fits and all(b[2] == a[1] for a, b in zip(shapes, shapes[1:], strict=False))
    fits = fits and all(bias.shape == shape[:2] for (_, bias), shape in zip(pairs, shapes, strict=True))
    if fits:
        lengths = [(shapes[0][2],)] * 2 + [(shapes[-1][1],)] * 2
        fits = [values.shape for values in normalization] == lengths
    if not fits:
        raise InputFileError(
            f"{path}: its layers {shapes} do not follow on each other; write the network again"
        )
    if any((values <= 0).any() for values in normalization[1::2]):
        raise InputFileError(f"{path}: a standard deviation is not above 0; write the network again")


def _check_fit(path: Path, card: PhaseNetworkCard, layout_id: str) -> None:
    for what, made_for, here in (
        ("layout", card.layout_id, layout_id),
        ("humanoid", card.humanoid_id, HUMANOID.id),
    ):
        if made_for != here:
            raise PolicyMismatchError(
                f"{path}: made for the {what} {made_for or 'of another body'}, this program has {here}; "
                "train one with `unicon pfnn train`"
            )
