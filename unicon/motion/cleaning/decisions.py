"""What cleaning is told, what it decides, and what it returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from unicon.motion.source_motion import SourceMotion

What = Literal["cut", "drop", "keep", "mark", "repair", "resample"]

REASONS = {
    "by_hand": "a person said so in the file of overrides",
    "too_short": "what is left between two cuts is too short for a clip",
    "rest_pose": "a pose with the arms out was put before or after the take",
    "no_motion": "nothing moves",
    "interpolated": "all joints and the root move at constant speeds: made by a program, not captured",
    "frozen": "the capture stood still for a while",
    "repeated_frames": "frames repeat the one before",
    "frame_rate": "the file says another rate than that of the capture",
    "root_jump": "the root jumps or spins as no person can",
    "root_drift": "the whole body slides over the floor",
    "zero_root": "the root stays at one place while the legs go on",
    "joint_flip": "a joint turns faster than any person's",
    "idle_end": "the take begins or ends with long stillness",
    "in_place": "the root never moves: the path was taken out",
    "prop": "something that is not in the data carries the body",
    "uneven_ground": "the feet stand at several heights",
}
"""The codes of decisions, and what they mean."""

MARKS = ("in_place", "prop", "uneven_ground")
"""Why a clip may not be followed on flat ground without props; reasons that are also marks of the clip."""


@dataclass(frozen=True)
class Hints:
    """What is known of a motion besides its frames."""

    file: str = ""
    """Where it is from, e.g. archive.zip/folder/take.bvh; overrides go by it."""
    description: str = ""
    """What it shows, in words."""
    label: str = ""
    """Its class, where it is known."""
    context: str = ""
    """What its session was about, in words."""
    capture_hz: float | None = None
    """Rate of the capture, where an index states it."""


def sentence(text: str) -> str:
    """Return words as a sentence."""
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


@dataclass(frozen=True)
class Decision:
    """One thing that cleaning did."""

    what: What
    first: int
    """First frame of the source file that it is about, from 0."""
    last: int
    """Last frame that it is about."""
    reason: str
    """One of ``REASONS``."""
    text: str
    """One sentence with what was measured."""

    def __str__(self) -> str:
        frames = f"frame {self.first}" if self.first == self.last else f"frames {self.first}-{self.last}"
        return f"{self.what} {frames} ({self.reason}): {self.text}"


@dataclass(frozen=True)
class Cleaning:
    """A motion after cleaning."""

    parts: tuple[SourceMotion, ...]
    """What is kept, in order of time; none when the motion cannot be used."""
    decisions: tuple[Decision, ...] = ()
    marks: tuple[str, ...] = ()
    """Some of ``MARKS``."""
