"""The card of a phase-functioned network: what it is, what it was made from, and how fast it may go."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from unicon.errors import InputFileError

FORMAT = 1
_JSON_TYPES: dict[str, type] = {"int": int, "Mapping": dict, "tuple": list}
_INTERPOLATIONS = ("cubic", "linear", "nearest")


@dataclass(frozen=True)
class PhaseNetworkCard:
    """What a network is."""

    name: str
    description: str
    layout_id: str
    """What its input and output mean: `unicon.schedulers.pfnn.layout.LAYOUT_ID`, or a name of another's."""
    humanoid_id: str = ""
    """Of the body that it moves; empty where that is not ours."""
    gaits: tuple[str, ...] = ()
    """Those it was trained on, in the order of the input."""
    training_data: tuple[str, ...] = ()
    """What it was trained on: a source a line, with the licence and how much."""
    takes: tuple[str, ...] = ()
    """Names of the takes it was trained on."""
    held_out_takes: tuple[str, ...] = ()
    """Names of the takes that it has never seen, by which it is judged."""
    training: str = ""
    """How it was trained."""
    limits: Mapping[str, float] = field(default_factory=dict)
    """Fastest it was trained to go: forward_m_s, backward_m_s, sideways_m_s, turn_rad_s."""
    gait_speeds_m_s: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    """Slow, usual and fast speed of each gait (10th, 50th, 90th percentile) [m/s]."""
    held_out_error: Mapping[str, float] = field(default_factory=dict)
    """On the held-out takes: root mean square error of each part of the output in its unit, and "loss"."""
    commit: str = ""
    """Of the program that trained it."""
    seed: int = 0
    sizes: tuple[int, ...] = ()
    """Size of the input, then the outputs of each layer; written on saving."""
    phases: int = 0
    """At how many phases the file holds weights; written on saving."""
    interpolation: str = "cubic"
    """Between these: cubic, linear or nearest; written on saving."""
    self_check: tuple[float, ...] = ()
    """Its output for a fixed input and phase, see `network_file`; written on saving."""
    format: int = FORMAT


def write_card(path: Path, card: PhaseNetworkCard) -> None:
    """Write a card as JSON.

    Raises:
        OSError: when it cannot be written.
    """
    path.write_text(json.dumps(vars(card), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def read_card(path: Path) -> PhaseNetworkCard:
    """Read a card.

    Raises:
        InputFileError: when it is missing, no JSON, or says something that a card does not.
    """
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputFileError(
            f"{path}: cannot be read ({error.strerror}); a phase network needs it beside its weights"
        ) from error
    except ValueError as error:
        raise InputFileError(f"{path}: is not JSON ({error}); write the network again") from error
    if not isinstance(values, dict):
        raise InputFileError(f"{path}: expected a JSON object, got {type(values).__name__}")
    known = {part.name: part for part in dataclasses.fields(PhaseNetworkCard)}
    for name in known:
        if name not in values:
            raise InputFileError(f"{path}: the field {name!r} is missing; write the network again")
    for name, value in values.items():
        if name not in known:
            raise InputFileError(f"{path}: unknown field {name!r}; is it of a newer version?")
        _check_field(path, name, str(known[name].type), value)
    lists = {name: tuple(value) for name, value in values.items() if isinstance(value, list)}
    speeds = {gait: tuple(speed) for gait, speed in values["gait_speeds_m_s"].items()}
    return PhaseNetworkCard(**{**values, **lists, "gait_speeds_m_s": speeds})


def _check_field(path: Path, name: str, kind: str, value: Any) -> None:
    expected = _JSON_TYPES.get(kind.partition("[")[0], str)
    if not isinstance(value, expected) or isinstance(value, bool):
        raise InputFileError(
            f"{path}: {name!r} is a {type(value).__name__}, expected {expected.__name__}; write it again"
        )
    if name == "gait_speeds_m_s":
        if not all(isinstance(speeds, list) and len(speeds) == 3 for speeds in value.values()):
            raise InputFileError(f"{path}: {name!r} holds {value!r}, expected three speeds for each gait")
        value = dict(enumerate(speed for speeds in value.values() for speed in speeds))
    if expected in (list, dict):
        items = value if expected is list else list(value.values())
        _check_items(path, name, (str,) if "str, ..." in kind else (int, float), items)
    if name == "format" and value != FORMAT:
        raise InputFileError(f"{path}: has the format {value}, this program reads {FORMAT}")
    if name == "interpolation" and value not in _INTERPOLATIONS:
        raise InputFileError(f"{path}: 'interpolation' is {value!r}, expected one of {_INTERPOLATIONS}")


def _check_items(path: Path, name: str, kinds: tuple[type, ...], items: list[Any]) -> None:
    for item in items:
        if not isinstance(item, kinds) or isinstance(item, bool):
            wanted = "texts" if kinds == (str,) else "numbers"
            raise InputFileError(f"{path}: {name!r} holds {item!r}, expected {wanted}")
