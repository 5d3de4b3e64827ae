"""The class of a motion, a path in a tree of any depth such as ``walking/forward``, told by its words.

The rules are in ``classes.yaml``; single clips whose words tell nothing are in ``by_hand.yaml``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import yaml

from unicon.motion.catalogue.about import About, words
from unicon.motion.catalogue.by_hand import by_hand
from unicon.motion.catalogue.class_tree import OTHER


@dataclass(frozen=True)
class _Rule:
    path: str
    said: re.Pattern[str] | None
    around: re.Pattern[str] | None

    def fits(self, said: str, around: str) -> bool:
        if self.said is not None and self.said.search(said) is None:
            return False
        return self.around is None or self.around.search(around) is not None


@dataclass(frozen=True)
class _Rules:
    classes: tuple[_Rule, ...]
    styles: tuple[_Rule, ...]
    styled: frozenset[str]


def classify(about: About) -> str:
    """Return the class of a motion.

    A person's label comes first (as it is where it holds a slash or is a class, else through the rules),
    then the decisions by hand, then the rules on its description, then the rules on its context.
    """
    if about.label:
        return _labelled(about.label)
    decided = by_hand().classes.get(about.key)
    return decided or classify_words(about.description, about.context)


def classify_words(description: str, context: str = "") -> str:
    """Return the class that the rules give to these words, ``other`` where none fits."""
    said, around = words(description), words(context)
    rules = _rules()
    alone = (rule for rule in rules.classes if rule.around is None)
    found = _first(rules.classes, said, around) or _first(alone, around, "") or OTHER
    style = _first(rules.styles, said, around) if found in rules.styled else None
    return f"{found}/{style}" if style else found


def normalize(label: str) -> str:
    """Return a class path in small letters, without spaces or empty parts."""
    parts = (re.sub(r"[\s-]+", "_", part.strip().lower()) for part in label.split("/"))
    return "/".join(part for part in parts if part) or OTHER


def known_classes() -> frozenset[str]:
    """Return the classes of the rules and all above them."""
    paths = [rule.path for rule in _rules().classes]
    return frozenset(path.rsplit("/", up)[0] for path in paths for up in range(path.count("/") + 1)) | {OTHER}


def _labelled(label: str) -> str:
    path = normalize(label)
    if "/" in path or path in known_classes():
        return path
    found = classify_words(label)
    return path if found == OTHER else found


def _first(rules: Iterable[_Rule], said: str, around: str) -> str | None:
    return next((rule.path for rule in rules if rule.fits(said, around)), None)


@cache
def _rules() -> _Rules:
    text = files("unicon.motion.catalogue").joinpath("classes.yaml").read_text(encoding="utf-8")
    content = yaml.safe_load(text)
    classes = tuple(_rule(entry["class"], entry) for entry in content["rules"])
    styles = tuple(_rule(entry["style"], entry) for entry in content["styles"])
    return _Rules(classes, styles, frozenset(content["styled_classes"]))


def _rule(path: str, entry: dict[str, str]) -> _Rule:
    said, around = (re.compile(entry[key]) if key in entry else None for key in ("said", "around"))
    return _Rule(path, said, around)
