"""Reads ``by_hand.yaml``: what a person decided where no words tell."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import yaml


@dataclass(frozen=True)
class ByHand:
    """Decisions by key (``collection/name``, see ``takes.key_of``)."""

    classes: dict[str, str]
    """Class of single clips."""
    takes: dict[str, str]
    """Key to the key that names its take."""
    partners: dict[int, int]
    """CMU subject to the subject whose trials are the same performances."""


@cache
def by_hand() -> ByHand:
    """Return the decisions."""
    text = files("unicon.motion.catalogue").joinpath("by_hand.yaml").read_text(encoding="utf-8")
    content = yaml.safe_load(text)
    takes = {key: group[0] for group in content["takes"] for key in group}
    partners = {other: first for first, other in content["partners"]}
    return ByHand(content["classes"], takes, partners)
