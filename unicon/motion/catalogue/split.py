"""Divides a library into training and test clips, class by class (as UniCon divides its data set).

Classes are taken from the least frequent up; a class with a single clip goes to the test set; on it goes
until a fifth of all frames is test. Here

- a class is a full label: the clips that carry exactly ``walking/forward`` are one class, and those of
  ``walking/forward/weary`` another, as for the balancer's last step;
- a clip is a take: mirrored copies, other formats and repeats of one performance count once and stay on
  one side, that of the first of their classes;
- of each class the test set gets the share of frames that is still missing, divided by the frames still
  to come, rounded to whole takes, but at least one take, and one stays for training. So the rare classes
  are all tested, and the frequent ones fill up to the wanted share;
- within a class the order is that of a hash of the take and the seed: neither the order of the clips nor
  the machine matters.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from unicon.errors import UniconError
from unicon.motion.catalogue.class_tree import class_parts
from unicon.motion.clip_index import ClipInfo, Split


@dataclass(frozen=True)
class SplitSettings:
    """How to divide."""

    test_share: float = 0.2
    """Share of all frames that the test set gets, about."""
    seed: int = 0
    """Another seed draws other takes of each class."""

    def __post_init__(self) -> None:
        if not 0.0 <= self.test_share < 1.0:
            raise UniconError(f"the test_share of a split is {self.test_share}, expected 0 up to below 1")


@dataclass(frozen=True)
class SplitPlan:
    """Which clip is on which side."""

    settings: SplitSettings
    sides: Mapping[str, Split]
    """Clip's name to train or test."""


@dataclass
class _Progress:
    """What has been given to the test set so far."""

    target: float
    to_come: int
    test: int = 0

    def share(self) -> float:
        """Return which part of the frames to come is still missing in the test set."""
        return max(self.target - self.test, 0.0) / self.to_come if self.to_come else 0.0


def split_clips(rows: Sequence[ClipInfo], settings: SplitSettings = SplitSettings()) -> SplitPlan:  # noqa: B008
    """Divide clips into training and test."""
    frames = _frames_of_takes(rows)
    classes = _classes(rows)
    total = sum(frames.values())
    progress = _Progress(target=settings.test_share * total, to_come=total)
    sides: dict[str, Split] = {}
    for label in sorted(classes, key=lambda label: (len(classes[label]), label)):
        undecided = classes[label] - sides.keys()
        tested = any(sides.get(take) == "test" for take in classes[label])
        chosen = _choose(undecided, frames, settings.seed, progress, len(classes[label]) == 1, tested)
        for take in undecided:
            sides[take] = "test" if take in chosen else "train"
        progress.test += sum(frames[take] for take in chosen)
        progress.to_come -= sum(frames[take] for take in undecided)
    names = sorted((info.name, take_name(info)) for info in rows)
    return SplitPlan(settings, {name: sides[take] for name, take in names})


def take_name(info: ClipInfo) -> str:
    """Return the identity of a clip's performance; one that states none is a take of its own."""
    return info.take or f"clip {info.name}"


def _frames_of_takes(rows: Sequence[ClipInfo]) -> dict[str, int]:
    frames: dict[str, int] = {}
    for info in rows:
        frames[take_name(info)] = frames.get(take_name(info), 0) + info.frames
    return frames


def _classes(rows: Sequence[ClipInfo]) -> dict[str, set[str]]:
    classes: dict[str, set[str]] = {}
    for info in rows:
        classes.setdefault("/".join(class_parts(info.label)), set()).add(take_name(info))
    return classes


def _choose(
    undecided: set[str],
    frames: Mapping[str, int],
    seed: int,
    progress: _Progress,
    single: bool,
    tested: bool,
) -> list[str]:
    """Return the takes of one class that go to the test set."""
    if progress.test >= progress.target:
        return []
    if single:
        return sorted(undecided)
    quota = progress.share() * sum(frames[take] for take in undecided)
    chosen: list[str] = []
    given = 0
    for take in sorted(undecided, key=lambda take: _rank(take, seed))[: len(undecided) - (not tested)]:
        nearer = given + frames[take] / 2 <= quota
        if nearer or not (tested or chosen):
            chosen.append(take)
            given += frames[take]
    return chosen


def _rank(take: str, seed: int) -> bytes:
    """Return a number that looks random, the same on every machine."""
    return hashlib.sha256(f"{seed}:{take}".encode()).digest()
