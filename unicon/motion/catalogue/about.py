"""What is known of a motion before it is read: its names, and for CMU takes their descriptions."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePosixPath

from unicon.motion.catalogue.cmu_index import cmu_take
from unicon.motion.catalogue.takes import key_of, plain_name

_SAYS_NOTHING = {"", "unknown", "clean", "cleaned", "no movie", "movie and trial dont match", "bad amc"}
_CONTEXT_FOLDERS = 2


@dataclass(frozen=True)
class About:
    """Words that tell what a motion is."""

    name: str
    """The file's name without suffix."""
    key: str = ""
    """``collection/name``, the key of decisions by hand."""
    description: str = ""
    """What it shows; for CMU takes from the index, else the words of its name."""
    context: str = ""
    """What it belongs to; for CMU takes the subject's session, else the words of its folders."""
    label: str = ""
    """Class given by a person."""


def describe(origin: str, label: str = "") -> About:
    """Return what names and the CMU index say of a file.

    Args:
        origin: its path, or ``archive.zip/inner/path.bvh``.
        label: class or words given by a person.
    """
    path = PurePosixPath(origin.replace("\\", "/"))
    take = cmu_take(path.stem)
    if take is not None:
        said = "" if take.description.lower() in _SAYS_NOTHING else take.description
        return About(path.stem, key_of(origin), said, take.subject_description, label)
    folders = " ".join(path.parts[:-1][-_CONTEXT_FOLDERS:])
    return About(path.stem, key_of(origin), plain_name(path.stem), folders, label)


def words(text: str) -> str:
    """Return a text's words in small letters, ``CamelCase`` and ``under_scores`` taken apart.

    Digits stand apart from letters, so ``JumpTurn180`` gives ``jump turn 180``.
    """
    text = re.sub(r"([a-z])([A-Z])", r"\1 \2", text)
    text = re.sub(r"([A-Z])([A-Z][a-z])", r"\1 \2", text)
    text = re.sub(r"(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", text)
    return " ".join(re.sub(r"[_\-/,;.~()]+", " ", text).lower().split())
