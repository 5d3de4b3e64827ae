"""Turns the plain values of a YAML file into frozen dataclasses; every key and type is checked.

What is wrong is said with its place, e.g. ``mine.yaml: ppo.epochs is 'two', expected a whole number``.
"""

from __future__ import annotations

import dataclasses
import difflib
import types
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from unicon.errors import InputFileError, UniconError

T = TypeVar("T")
_KINDS = {int: "a whole number", float: "a number", str: "a text", bool: "true or false"}


def build(cls: type[T], values: Any, where: str, field: str = "") -> T:
    """Return a dataclass made of a mapping; what it does not name keeps its default.

    Args:
        cls: the dataclass, whose fields are numbers, texts, tuples, literals, paths or dataclasses.
        values: what YAML gave.
        where: file, for messages.
        field: dotted place within the file, for messages.

    Raises:
        InputFileError: on an unknown key, a wrong type, or a value that the dataclass refuses.
    """
    if not isinstance(values, Mapping):
        raise InputFileError(
            f"{where}: {field or 'the file'} is {_shown(values)}, expected names with values"
        )
    hints = get_type_hints(cls)
    known = [item.name for item in dataclasses.fields(cls)]  # type: ignore[arg-type]
    prefix = f"{field}." if field else ""
    for key in values:
        if key not in known:
            near = difflib.get_close_matches(str(key), known, 1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise InputFileError(f"{where}: there is no setting {prefix}{key}; {hint}")
    made = {key: _convert(hints[key], value, where, f"{prefix}{key}") for key, value in values.items()}
    try:
        return cls(**made)
    except UniconError as error:
        raise InputFileError(f"{where}: {error}") from error
    except TypeError as error:
        raise InputFileError(f"{where}: {field or 'the file'} lacks a setting ({error})") from error


def plain(value: Any) -> Any:
    """Return a dataclass as the plain values that ``build`` reads."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {item.name: plain(getattr(value, item.name)) for item in dataclasses.fields(value)}
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    return str(value) if isinstance(value, Path) else value


def _convert(hint: Any, value: Any, where: str, field: str) -> Any:
    """Return a value as the type that a field has."""
    origin = get_origin(hint)
    if dataclasses.is_dataclass(hint) and isinstance(hint, type):
        return build(hint, value, where, field)
    if origin is Literal:
        if value in get_args(hint):
            return value
        choices = ", ".join(map(str, get_args(hint)))
        raise InputFileError(f"{where}: {field} is {_shown(value)}, expected one of {choices}")
    if origin in (Union, types.UnionType):
        return _convert_union(hint, value, where, field)
    if origin is tuple:
        return _convert_tuple(get_args(hint), value, where, field)
    if hint is Path and isinstance(value, str):
        return Path(value)
    return _convert_scalar(hint, value, where, field)


def _convert_scalar(hint: Any, value: Any, where: str, field: str) -> Any:
    if hint is float and isinstance(value, int | float | str) and not isinstance(value, bool):
        try:
            return float(value)  # YAML takes 3e-4 for a text
        except ValueError:
            pass
    fits = isinstance(value, hint) and not (hint is not bool and isinstance(value, bool))
    if not fits:
        raise InputFileError(
            f"{where}: {field} is {_shown(value)}, expected {_KINDS.get(hint, hint.__name__)}"
        )
    return value


def _convert_tuple(items: tuple[Any, ...], value: Any, where: str, field: str) -> tuple[Any, ...]:
    if not isinstance(value, list | tuple):
        raise InputFileError(f"{where}: {field} is {_shown(value)}, expected a list")
    endless = len(items) == 2 and items[1] is Ellipsis
    if not endless and len(items) != len(value):
        raise InputFileError(f"{where}: {field} has {len(value)} entries, expected {len(items)}")
    hints = [items[0]] * len(value) if endless else items
    return tuple(
        _convert(hint, item, where, f"{field}[{index}]")
        for index, (hint, item) in enumerate(zip(hints, value, strict=True))
    )


def _convert_union(hint: Any, value: Any, where: str, field: str) -> Any:
    """Return None or the value as one of the other types: the first that takes it."""
    choices = [choice for choice in get_args(hint) if choice is not type(None)]
    if value is None and len(choices) < len(get_args(hint)):
        return None
    for choice in choices[:-1]:
        try:
            return _convert(choice, value, where, field)
        except InputFileError:
            continue
    return _convert(choices[-1], value, where, field)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
