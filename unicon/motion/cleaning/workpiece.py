"""A motion on its way through the steps of cleaning: what is kept of it, and what was decided."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon.motion.cleaning.body_paths import BodyPaths, body_paths
from unicon.motion.cleaning.decisions import Decision, What
from unicon.motion.cleaning.frozen_frames import changes
from unicon.motion.grounding.smooth_change import spans
from unicon.motion.source_motion import SourceMotion

SHORTEST_S = 0.5
"""A shorter part is no clip."""
FEWEST_FRAMES = 4

_ARRAYS = ("times_s", "root_pos", "local_quat", "local_pos")


class Workpiece:
    """T frames, fewer as the work goes on."""

    def __init__(self, motion: SourceMotion) -> None:
        self.motion = motion
        self.paths = body_paths(motion)
        self.changes = changes(self.paths)
        """How much each frame differs from the next ``(T-1,)`` [rad or m]."""
        self.decisions: list[Decision] = []
        self.kept = np.ones(len(motion.times_s), dtype=bool)
        """Which frames are not cut ``(T,)``."""
        self._numbers = np.arange(len(motion.times_s))
        self._breaks: set[int] = set()

    def note(self, what: What, first: int, last: int, reason: str, text: str) -> None:
        """Write down a decision about frames from first to last."""
        first, last = int(self._numbers[first]), int(self._numbers[last])
        self.decisions.append(
            Decision(what, first, last, reason, f"{text[:1].upper()}{text[1:].rstrip('.')}.")
        )

    def cut(self, start: int, stop: int, reason: str, text: str, what: What = "cut") -> None:
        """Cut the frames from start to before stop, if they are not cut yet."""
        stop = min(stop, len(self.kept))
        if self.kept[start:stop].any():
            self.kept[start:stop] = False
            self.note(what, start, stop - 1, reason, text)

    def break_before(self, frame: int, reason: str, text: str) -> None:
        """Let one part end and another begin between two frames."""
        if frame not in self._breaks and self.kept[frame - 1 : frame + 1].all():
            self._breaks.add(frame)
            self.note("cut", frame, frame, reason, text)

    def cut_by_number(self, first: int, last: int, reason: str, text: str) -> None:
        """Cut frames given as the source file numbers them."""
        inside = np.flatnonzero((self._numbers >= first) & (self._numbers <= last))
        if len(inside):
            self.cut(int(inside[0]), int(inside[-1]) + 1, reason, text)

    def select(self, mask: np.ndarray) -> None:
        """Leave out frames for good, without a break; the times of the others stay."""
        self.motion, self.paths = take_frames(self.motion, mask), self.paths.take(mask)
        self._numbers, self.kept = self._numbers[mask], self.kept[mask]
        self.changes = changes(self.paths)

    def scale_rate(self, factor: float, reason: str, text: str) -> None:
        """Make the rate so many times as high."""
        self.note("resample", 0, len(self.kept) - 1, reason, text)
        self.motion = replace(self.motion, times_s=self.motion.times_s / factor)
        self.paths = replace(self.paths, times_s=self.motion.times_s)

    def replace_rotations(self, local_quat: np.ndarray) -> None:
        """Take other rotations ``(T, J, 4)``."""
        self.motion = replace(self.motion, local_quat=local_quat)
        self.paths = body_paths(self.motion)

    @property
    def kept_paths(self) -> BodyPaths:
        """The frames that are not cut."""
        return self.paths if self.kept.all() else self.paths.take(self.kept)

    def pieces(self) -> list[tuple[int, int]]:
        """Return what is left, as pairs of the first frame and the one after the last; too short ones go."""
        pieces = []
        for start, stop in spans(self.kept):
            edges = [start, *sorted(b for b in self._breaks if start < b < stop), stop]
            pieces += list(zip(edges[:-1], edges[1:], strict=True))
        if len(pieces) == 1 and pieces[0] == (0, len(self.kept)):
            return pieces
        return [piece for piece in pieces if not self._drop_short(*piece)]

    def _drop_short(self, start: int, stop: int) -> bool:
        seconds = float(self.motion.times_s[stop - 1] - self.motion.times_s[start])
        short = seconds < SHORTEST_S or stop - start < FEWEST_FRAMES
        if short:
            self.kept[start:stop] = False
            self.note("drop", start, stop - 1, "too_short", f"only {seconds:.2f} s are left between cuts")
        return short

    def parts(self) -> tuple[SourceMotion, ...]:
        """Return what is left, in order of time; of several parts the second is called "take_b" and so on."""
        pieces = self.pieces()
        return tuple(self._part(start, stop, number) for number, (start, stop) in enumerate(pieces))

    def _part(self, start: int, stop: int, number: int) -> SourceMotion:
        motion = take_frames(self.motion, slice(start, stop))
        whole = stop - start == len(self.kept)
        return replace(
            motion,
            name=f"{motion.name}{_ending(number)}",
            times_s=motion.times_s - motion.times_s[0],
            loop=motion.loop and whole,
        )


def take_frames(motion: SourceMotion, frames: np.ndarray | slice) -> SourceMotion:
    """Return some frames of a motion."""
    arrays = {name: getattr(motion, name) for name in _ARRAYS}
    return replace(motion, **{name: array[frames] for name, array in arrays.items() if array is not None})


def _ending(number: int) -> str:
    if number == 0:
        return ""
    return f"_{'bcdefghijklmnopqrstuvwxyz'[number - 1]}" if number < 26 else f"_{number + 1}"
