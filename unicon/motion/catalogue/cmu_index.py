"""The index of the CMU motion capture database: what each take shows, as its makers describe it.

``cmu_index.csv`` holds subject, trial, rate, description of the take and of the subject's session, from
mocap.cs.cmu.edu (free for all uses; created with funding from NSF EIA-0196217).
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

_STEM = re.compile(
    r"(?:cmu[_ -]?)?0*(?P<subject>\d{1,3})_0*(?P<trial>\d{1,3})"
    r"(?:[_~-]?(?:cmu|poses|stageii|clean|mirror(?:ed)?|flip(?:ped)?|m))*",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class CmuTake:
    """One take of the database."""

    subject: int
    trial: int
    rate_hz: float
    """Rate of the capture; AMC files do not state it."""
    description: str
    """What the take shows, e.g. walk; empty or "Unknown" for some."""
    subject_description: str
    """What the subject's session was about."""

    @property
    def name(self) -> str:
        """The usual name of its files, e.g. 07_01."""
        return f"{self.subject:02d}_{self.trial:02d}"


@cache
def cmu_index() -> Mapping[tuple[int, int], CmuTake]:
    """Return all takes by subject and trial."""
    text = files("unicon.motion.catalogue").joinpath("cmu_index.csv").read_text(encoding="utf-8")
    takes = [
        CmuTake(
            int(row["subject"]),
            int(row["trial"]),
            float(row["rate_hz"]),
            row["description"],
            row["subject_description"],
        )
        for row in csv.DictReader(text.splitlines())
    ]
    return {(take.subject, take.trial): take for take in takes}


def cmu_take(stem: str) -> CmuTake | None:
    """Return the take that a file's name means, e.g. ``07_01``, ``CMU_7_1`` or ``07_01_mirrored``.

    A name of another source may look the same; of two numbers, only those that the index holds count.
    """
    match = _STEM.fullmatch(stem)
    if match is None:
        return None
    return cmu_index().get((int(match["subject"]), int(match["trial"])))
