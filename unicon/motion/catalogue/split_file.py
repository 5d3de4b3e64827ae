"""The file of a split: its settings, and the side of each clip, in YAML that a person can read and change."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, cast

import yaml

from unicon.errors import InputFileError, UniconError
from unicon.motion.catalogue.split import SplitPlan, SplitSettings, take_name
from unicon.motion.clip_index import ClipInfo, Split

VERSION = 1
SIDES = ("train", "test")

_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def write_split(plan: SplitPlan, path: Path) -> None:
    """Write a split, one line a clip.

    Raises:
        InputFileError: when the file cannot be written.
    """
    content = {"version": VERSION, "settings": asdict(plan.settings), "clips": dict(plan.sides)}
    try:
        path.write_text(yaml.safe_dump(content, sort_keys=False, width=1000), encoding="utf-8")
    except OSError as error:
        raise InputFileError(f"{path}: cannot be written ({error.strerror})") from error


def read_split(path: Path) -> SplitPlan:
    """Read a split.

    Raises:
        InputFileError: when it is no split; the message names the line.
    """
    try:
        node = yaml.compose(path.read_text(encoding="utf-8"), Loader=_Loader)
    except (OSError, UnicodeDecodeError) as error:
        raise InputFileError(f"{path}: cannot be read ({error})") from error
    except yaml.YAMLError as error:
        text = " ".join(str(error).split())
        raise InputFileError(f"{path}: is not YAML ({text}); make the split again") from error
    parts = _mapping(path, node, "the file")
    version = _scalar(parts.get("version"))
    if version != str(VERSION):
        raise InputFileError(f"{path}: has version {version or 'none'}, expected {VERSION}; make it again")
    return SplitPlan(_settings(path, parts.get("settings")), _sides(path, parts.get("clips")))


def apply_split(rows: Sequence[ClipInfo], plan: SplitPlan, path: Path) -> list[ClipInfo]:
    """Return the rows with the sides that a split, read from ``path``, gives them.

    Raises:
        InputFileError: when the split lacks a clip, or puts copies of one take on both sides.
    """
    first_of_take: dict[str, ClipInfo] = {}
    decided = []
    for info in rows:
        side = plan.sides.get(info.name)
        if side is None:
            near = difflib.get_close_matches(info.name, plan.sides, n=1)
            hint = f" (the nearest there is {near[0]!r})" if near else ""
            raise InputFileError(f"{path}: lacks the clip {info.name!r}{hint}; make the split again")
        first = first_of_take.setdefault(take_name(info), info)
        if plan.sides[first.name] != side:
            raise InputFileError(
                f"{path}: {info.name!r} is {side} but {first.name!r}, the same take {take_name(info)!r}, "
                f"is {plan.sides[first.name]}; put both on one side"
            )
        decided.append(replace(info, split=side))
    return decided


def _settings(path: Path, node: Any) -> SplitSettings:
    parts = _mapping(path, node, "'settings'")
    try:
        return SplitSettings(float(_scalar(parts["test_share"])), int(_scalar(parts["seed"])))
    except UniconError as error:
        line = node.start_mark.line + 1
        raise InputFileError(f"{path}, line {line}: {error}") from error
    except (KeyError, ValueError) as error:
        line = node.start_mark.line + 1
        raise InputFileError(f"{path}, line {line}: expected numbers test_share and seed") from error


def _sides(path: Path, node: Any) -> dict[str, Split]:
    sides: dict[str, Split] = {}
    for name, value in _mapping(path, node, "'clips'").items():
        side = _scalar(value)
        if side not in SIDES:
            line = value.start_mark.line + 1
            raise InputFileError(f"{path}, line {line}: clip {name!r} is {side!r}, expected train or test")
        sides[name] = cast(Split, side)
    return sides


def _mapping(path: Path, node: Any, what: str) -> dict[str, Any]:
    if not isinstance(node, yaml.MappingNode):
        line = node.start_mark.line + 1 if node is not None else 1
        raise InputFileError(f"{path}, line {line}: {what} holds no entries 'name: value'")
    parts: dict[str, Any] = {}
    for key, value in node.value:
        name = _scalar(key)
        if name in parts:
            line = key.start_mark.line + 1
            raise InputFileError(f"{path}, line {line}: {name!r} stands there twice; remove one")
        parts[name] = value
    return parts


def _scalar(node: Any) -> str:
    return str(node.value) if isinstance(node, yaml.ScalarNode) else ""
