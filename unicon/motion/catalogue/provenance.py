"""Where a file comes from and what may be done with it, told by the names of its folders and archives."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import PurePosixPath

import yaml

UNKNOWN_LICENCE = "unknown"
_INNERMOST = 4
"""Folders looked at: those far above a file say more about the machine than about the file."""


@dataclass(frozen=True)
class Provenance:
    """Source and licence of a file."""

    collection: str
    """Short name of the collection, e.g. cmu; for unknown ones the last two folders."""
    source: str
    licence: str
    credit: str = ""
    """The line to print where its motions are used; empty where none is known."""
    shippable: bool = False
    """Whether its clips, and networks trained on them, may be part of a product."""


@dataclass(frozen=True)
class _Rule:
    folder: re.Pattern[str]
    file: re.Pattern[str]
    provenance: Provenance


def provenance_of(origin: str, source: str = "", licence: str = "") -> Provenance:
    """Return where a file comes from.

    Args:
        origin: its path, or ``archive.zip/inner/path.bvh``.
        source: given by a person; stands instead of what the names tell.
        licence: the same; a collection that is not known stays not shippable.
    """
    path = PurePosixPath(origin.replace("\\", "/"))
    known = _known(path)
    if known is None:
        folder = path.parent
        short = "/".join(part for part in folder.parts[-2:] if part not in ("/", "."))
        return Provenance(short, source or str(folder), licence or UNKNOWN_LICENCE)
    return Provenance(
        known.collection, source or known.source, licence or known.licence, known.credit, known.shippable
    )


def _known(path: PurePosixPath) -> Provenance | None:
    for folder in _folders(path):
        for rule in _rules():
            if rule.folder.search(folder) and rule.file.search(path.stem.lower()):
                return rule.provenance
    return None


def _folders(path: PurePosixPath) -> Iterator[str]:
    """Yield the innermost folders' names in small letters, an archive's without suffix."""
    for part in reversed(path.parts[:-1][-_INNERMOST:]):
        yield re.sub(r"\.(zip|tar|whl|tgz|tar\.gz)$", "", part.lower())


@cache
def _rules() -> tuple[_Rule, ...]:
    text = files("unicon.motion.catalogue").joinpath("provenance.yaml").read_text(encoding="utf-8")
    rules = []
    for entry in yaml.safe_load(text):
        folder, file = re.compile(entry.pop("folder")), re.compile(entry.pop("file", ""))
        rules.append(_Rule(folder, file, Provenance(**entry)))
    return tuple(rules)
