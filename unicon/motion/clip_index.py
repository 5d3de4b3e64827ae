"""What a library knows of each clip without reading its frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

RATE_HZ = 60.0
"""Rate of every clip."""

Split = Literal["train", "test", ""]


@dataclass(frozen=True)
class ClipInfo:
    """One row of a library's index."""

    name: str
    """Unique in its library."""
    frames: int
    """Number of frames, at 60 Hz."""
    label: str = "other"
    """Its place in the class tree, e.g. walking/forward."""
    take: str = ""
    """Identity of the performance: mirrored copies, other formats and repeats of one take share it."""
    source: str = ""
    """Where it was captured or made."""
    licence: str = ""
    origin: str = ""
    """The file it was made from, e.g. archive.zip/folder/take.bvh."""
    split: Split = ""
    marks: tuple[str, ...] = ()
    """Why it may not be followed on flat ground without props, e.g. prop, uneven_ground."""
    quality: Mapping[str, float] = field(default_factory=dict)
    """The figures of its retargeting by name, e.g. mean_error_mm."""

    @property
    def seconds(self) -> float:
        """Time from the first frame to the last."""
        return (self.frames - 1) / RATE_HZ
