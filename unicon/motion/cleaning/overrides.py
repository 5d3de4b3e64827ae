"""A small file by which a person overrules cleaning.

A YAML list; each entry says which clips it is about, what to do, and why:

    - clips: cmu_daz_bvh.zip/60_*   # pattern of the file (* and ?); without a slash, of its name alone
      reason: the partner stands in the way
      drop: true                    # leave these clips out, or
      keep: true                    # decide nothing on our own about them, or
      ignore: [idle_end]            # don't decide for these reasons
      cut: [[0, 12], [300, 310]]    # frames of the source file to cut, first and last, from 0
      rate_hz: 60                   # the rate is this one, whatever the file says
      mark: [prop]                  # add marks
      unmark: [uneven_ground]       # remove marks

Entries that fit the same clip add up; of two rates the later one holds.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

from unicon.errors import InputFileError
from unicon.motion.cleaning.decisions import MARKS, REASONS

_ACTIONS = ("drop", "keep", "ignore", "cut", "rate_hz", "mark", "unmark")
_KEYS = ("clips", "reason", *_ACTIONS)


@dataclass(frozen=True)
class Order:
    """What a person wants done with a clip."""

    clips: str = "*"
    """Pattern of the files."""
    reason: str = ""
    drop: bool = False
    keep: bool = False
    ignore: tuple[str, ...] = ()
    cut: tuple[tuple[int, int], ...] = ()
    """First and last frame of each stretch."""
    rate_hz: float | None = None
    mark: tuple[str, ...] = ()
    unmark: tuple[str, ...] = ()

    def fits(self, file: str) -> bool:
        """Return whether it is about a file."""
        name = file.replace("\\", "/").lower()
        stem = name.rpartition("/")[2]
        pattern = self.clips.lower()
        if "/" not in pattern:
            return fnmatchcase(stem, pattern) or fnmatchcase(stem.rpartition(".")[0], pattern)
        return any(
            fnmatchcase(text, end)
            for text in (name, name.rpartition(".")[0])
            for end in (pattern, f"*/{pattern}")
        )

    def ignores(self, reason: str) -> bool:
        """Return whether nothing is to be decided for this reason."""
        return self.keep or reason in self.ignore


@dataclass(frozen=True)
class Overrides:
    """All orders of a file."""

    orders: tuple[Order, ...] = ()

    def of(self, file: str) -> Order:
        """Return what all orders that fit a file come to."""
        total = Order()
        for order in self.orders:
            if order.fits(file):
                total = _add(total, order)
        return total


def shipped_overrides() -> Overrides:
    """Return those that come with the program, for the clips that it is known to be wrong about."""
    return load_overrides(Path(str(files("unicon.motion.cleaning").joinpath("overrides.yaml"))))


def load_overrides(path: Path) -> Overrides:
    """Read a file of overrides.

    Raises:
        InputFileError: when it cannot be read or an entry is wrong; the message names the entry.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputFileError(f"{path}: cannot be read ({error.strerror})") from error
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        where = getattr(error, "problem_mark", None)
        line = f", line {where.line + 1}" if where else ""
        raise InputFileError(
            f"{path}{line}: is not YAML; expected a list of entries with 'clips' and 'reason'"
        ) from None
    if content is None:
        return Overrides()
    if not isinstance(content, list):
        raise InputFileError(
            f"{path}: holds a {type(content).__name__}, expected a list of entries ('- clips: ...')"
        )
    return Overrides(tuple(_Entry(path, number, entry).order() for number, entry in enumerate(content, 1)))


class _Entry:
    """One entry of a file, with what its error messages need."""

    def __init__(self, path: Path, number: int, content: Any) -> None:
        self._content = content
        self._where = f"{path}, entry {number}"
        if isinstance(content, dict) and content.get("clips"):
            self._where += f" ({content['clips']})"

    def order(self) -> Order:
        """Return what it says.

        Raises:
            InputFileError: when something in it is wrong.
        """
        content = self._content
        if not isinstance(content, dict):
            raise self._wrong(f"is a {type(content).__name__}, expected 'clips', 'reason' and what to do")
        for key in content:
            if key not in _KEYS:
                raise self._wrong(f"has the field {key!r}; known are {', '.join(_KEYS)}")
        if isinstance(content.get("clips"), int):
            raise self._wrong(
                "has a number for 'clips'; put the pattern in quotes, as YAML reads 60_01 as 6001"
            )
        for key in ("clips", "reason"):
            if not isinstance(content.get(key), str) or not content[key].strip():
                raise self._wrong(f"lacks the text {key!r}")
        if not any(key in content for key in _ACTIONS):
            raise self._wrong(f"says nothing to do; expected one of {', '.join(_ACTIONS)}")
        if content.get("drop") and content.get("keep"):
            raise self._wrong("says both drop and keep; leave one of them")
        return Order(
            clips=content["clips"],
            reason=content["reason"].strip(),
            drop=self._flag("drop"),
            keep=self._flag("keep"),
            ignore=self._names("ignore", REASONS),
            cut=self._ranges(),
            rate_hz=self._rate(),
            mark=self._names("mark", MARKS),
            unmark=self._names("unmark", MARKS),
        )

    def _flag(self, key: str) -> bool:
        value = self._content.get(key, False)
        if not isinstance(value, bool):
            raise self._wrong(f"has {key}: {value!r}, expected true or false")
        return value

    def _names(self, key: str, known: Iterable[str]) -> tuple[str, ...]:
        value = self._content.get(key, [])
        if not isinstance(value, list):
            raise self._wrong(f"has {key}: {value!r}, expected a list such as [{next(iter(known))}]")
        for name in value:
            if name not in known:
                raise self._wrong(f"has {name!r} in {key}; known are {', '.join(known)}")
        return tuple(value)

    def _ranges(self) -> tuple[tuple[int, int], ...]:
        value = self._content.get("cut", [])
        if not isinstance(value, list):
            raise self._wrong(f"has cut: {value!r}, expected a list such as [[0, 12]]")
        for pair in value:
            whole = isinstance(pair, list) and len(pair) == 2 and all(type(n) is int for n in pair)
            if not whole or not 0 <= pair[0] <= pair[1]:
                raise self._wrong(f"has {pair!r} in cut, expected first and last frame, such as [0, 12]")
        return tuple((pair[0], pair[1]) for pair in value)

    def _rate(self) -> float | None:
        value = self._content.get("rate_hz")
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int | float) or not 1 <= value <= 1000:
            raise self._wrong(f"has rate_hz: {value!r}, expected a number from 1 to 1000")
        return float(value)

    def _wrong(self, problem: str) -> InputFileError:
        return InputFileError(f"{self._where}: {problem}")


def _add(a: Order, b: Order) -> Order:
    return replace(
        a,
        reason="; ".join(text for text in (a.reason, b.reason) if text),
        drop=a.drop or b.drop,
        keep=a.keep or b.keep,
        ignore=a.ignore + b.ignore,
        cut=a.cut + b.cut,
        rate_hz=b.rate_hz or a.rate_hz,
        mark=a.mark + b.mark,
        unmark=a.unmark + b.unmark,
    )
