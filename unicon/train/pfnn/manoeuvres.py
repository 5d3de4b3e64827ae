"""What the network shall be able to do, as sequences that begin and end in standing.

Straight walks and runs are bent both ways, played at other speeds and, walks, reversed; walks also go with
the body turned aside, and some with shorter strides and on the spot, turning. Side steps, steps backward and
turns on the spot are there as captured, too, the first two also bent. All is between stretches of standing,
and leans into bends and into changes of speed.
Names say what was made: ``07_01 bent +45 x0.85`` is the clip 07_01, bent by 45 degrees a second, at 0.85 of
its speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from unicon.errors import UnknownNameError
from unicon.motion.clip import clip_from_poses
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.store.library import ClipLibrary
from unicon.schedulers.dataset import at_speed
from unicon.state import CharacterState
from unicon.train.pfnn.cycles import loop
from unicon.train.pfnn.leaning import lean
from unicon.train.pfnn.strides import face_aside, shorten
from unicon.train.pfnn.synthesis import bend, calm_upper, reverse, sequence, turn_round
from unicon.train.pfnn.takes import TakeEntry, TakeTable, frames_of

WALK_BENDS = (0.0, 25.0, -25.0, 50.0, -50.0, 80.0, -80.0)
RUN_BENDS = (0.0, 30.0, -30.0, 55.0, -55.0)
REVERSE_BENDS = (0.0, 30.0, -30.0)
SPEEDS = (0.65, 0.75, 0.85, 1.0, 1.0, 1.1, 1.2)
DRAWS = 2
"""How many speeds each bend is made at."""
REVERSE_SPEEDS = (0.35, 0.5, 0.65, 0.8)
RUN_SPEEDS = (0.65, 0.75, 0.85, 0.95, 1.0)
CAPTURED_SPEEDS = (0.8, 0.9, 1.0, 1.1, 1.2)
CAPTURED_BENDS = {"backward": (0.0, 30.0), "sideways": (0.0, 30.0, -30.0), "turning": (0.0,)}
ASIDE_DEG = (20.0, 40.0)
"""Which way the body faces against that of a walk; mirrored, also the other way."""
SPINS = (30.0, 45.0, 60.0, -60.0, 75.0, 90.0)
"""Turn rates on the spot [degrees/s]."""
ON_THE_SPOT = 0.08
"""Share of a walk's strides that is left of steps on the spot."""
SHARES = (0.4, 0.5, 0.6)
SHORT_BENDS = (0.0, 40.0)
WALK_S, RUN_S, STEP_S = 0.9, 1.3, 0.5
"""Transitions between standing and a walk, a run and a step: nobody sets off at once."""
LOOP_S = 4.0
WALK_BEFORE_RUN_S = 1.5
_WANDER_S = 8.0


class Manoeuvre(NamedTuple):
    """A sequence, its feet not yet planted."""

    name: str
    """Begins with the name of the clip that it was made of."""
    kind: str
    """standing, walking, wandering, running, backward, sideways or turning."""
    parts: tuple[CharacterState, ...]
    """Motions, one after the other."""
    transition_s: float = 0.0
    """Length of the transitions between them [s]."""
    bent_deg_s: float = 0.0
    """Turn rate by which it is bent while it goes."""

    def make(self) -> CharacterState:
        """Return its frames ``(T,)``."""
        path = sequence(self.parts, [self.transition_s] * (len(self.parts) - 1))
        return lean(bend(path, np.radians(self.bent_deg_s)) if self.bent_deg_s else path, self.parts)


class ManoeuvreMaker:
    """Makes all sequences of a table of takes, the same with the same seed."""

    def __init__(
        self, table: TakeTable, library: ClipLibrary, seed: int, held_out: tuple[str, ...] = ()
    ) -> None:
        """Begin; ``held_out`` names clips that no manoeuvre of another clip shall hold."""
        self.missing: list[str] = []
        """Clips of the table that the library does not have."""
        self._rng = np.random.default_rng(seed)
        self._library, self._table, self._held_out = library, table, held_out
        self._upper: np.ndarray | None = None
        walks = [frames for _, frames in self._all(table.walking)]
        if walks:
            self._upper = np.mean([frames.joint_pos.mean(axis=0) for frames in walks], axis=0)
        self._stands = [frames for _, frames in self._all(table.standing)]

    def all(self) -> Iterator[Manoeuvre]:
        """Yield the sequences; none where the library has no standing or no walking clip."""
        if not self._stands or self._upper is None:
            return
        for entry, frames in self._all(self._table.standing):
            yield Manoeuvre(entry.clip, "standing", (frames,))
        yield from self._walks()
        yield from self._runs()
        yield from self._wandering()
        yield from self._aside()
        yield from self._steps()
        for kind in ("backward", "sideways", "turning"):
            yield from self._captured(kind, getattr(self._table, kind))

    def _walks(self) -> Iterator[Manoeuvre]:
        for entry, frames in self._all(self._table.walking):
            for bent in WALK_BENDS * DRAWS:
                speed = self._draw(SPEEDS)
                name = f"{entry.clip} bent {bent:+g} x{speed:g}"
                yield Manoeuvre(name, "walking", self._between_stands(_faster(frames, speed)), WALK_S, bent)
            for bent in REVERSE_BENDS * DRAWS:
                speed = self._draw(REVERSE_SPEEDS)
                name = f"{entry.clip} reversed bent {bent:+g} x{speed:g}"
                back = _faster(reverse(frames), speed)
                yield Manoeuvre(name, "backward", self._between_stands(back), WALK_S, bent)

    def _runs(self) -> Iterator[Manoeuvre]:
        """Yield runs out of a walk and into one, and straight from standing, in turns."""
        walks = [
            frames[: round(WALK_BEFORE_RUN_S * RATE_HZ)]
            for entry, frames in self._all(self._table.walking)
            if entry.clip not in self._held_out
        ]
        for entry, frames in self._all(self._table.running):
            for index, bent in enumerate(RUN_BENDS * DRAWS):
                speed = self._draw(RUN_SPEEDS)
                name, run = f"{entry.clip} bent {bent:+g} x{speed:g}", _faster(frames, speed)
                if index % 2 == 0 and walks:
                    walk = walks[self._rng.integers(len(walks))]
                    yield Manoeuvre(name, "running", self._between_stands(walk, run, walk), WALK_S, bent)
                else:
                    yield Manoeuvre(name, "running", self._between_stands(run), RUN_S, bent)

    def _wandering(self) -> Iterator[Manoeuvre]:
        length = round(_WANDER_S * RATE_HZ)
        for entry, frames in self._all(self._table.wandering):
            for start in range(0, frames.batch_shape[0] - length // 2, length // 2):
                part = frames[start : start + length]
                name = f"{entry.clip} from {start / RATE_HZ:g} s"
                yield Manoeuvre(name, "wandering", self._between_stands(part), WALK_S)

    def _aside(self) -> Iterator[Manoeuvre]:
        for entry, frames in self._all(self._table.walking):
            for angle in ASIDE_DEG:
                speed = self._draw(SPEEDS)
                walk = face_aside(_faster(frames, speed), np.radians(angle))
                name = f"{entry.clip} aside {angle:+g} x{speed:g}"
                yield Manoeuvre(name, "sideways", self._between_stands(walk), WALK_S)

    def _steps(self) -> Iterator[Manoeuvre]:
        """Yield turns on the spot and slow walks."""
        for entry, frames in self._all(self._table.stepping):
            on_the_spot = shorten(frames, ON_THE_SPOT)
            for rate in SPINS:
                turning = turn_round(on_the_spot, np.radians(rate))
                name = f"{entry.clip} on the spot {rate:+g}"
                yield Manoeuvre(name, "turning", self._between_stands(turning), STEP_S)
            for share in SHARES:
                for bent in SHORT_BENDS:
                    name = f"{entry.clip} strides {share:g} bent {bent:+g}"
                    parts = self._between_stands(shorten(frames, share))
                    yield Manoeuvre(name, "walking", parts, WALK_S, bent)

    def _captured(self, kind: str, entries: tuple[TakeEntry, ...]) -> Iterator[Manoeuvre]:
        for entry, frames in self._all(entries):
            for bent in CAPTURED_BENDS[kind]:
                for speed in CAPTURED_SPEEDS:
                    parts = self._between_stands(_faster(frames, speed))
                    name = f"{entry.clip} bent {bent:+g} x{speed:g}" if bent else f"{entry.clip} x{speed:g}"
                    yield Manoeuvre(name, kind, parts, STEP_S, bent)

    def _all(self, entries: tuple[TakeEntry, ...]) -> Iterator[tuple[TakeEntry, CharacterState]]:
        """Yield the takes that there are."""
        for entry in entries:
            try:
                frames = frames_of(entry, self._library)
            except UnknownNameError:
                if entry.clip not in self.missing:
                    self.missing.append(entry.clip)
                continue
            if entry.calm_upper and self._upper is not None:
                frames = calm_upper(frames, self._upper)
            if entry.loop:
                frames = loop(frames, LOOP_S) or frames
            yield entry, frames

    def _between_stands(self, *parts: CharacterState) -> tuple[CharacterState, ...]:
        return (self._stand(), *parts, self._stand())

    def _draw(self, speeds: tuple[float, ...]) -> float:
        return float(self._rng.choice(speeds))

    def _stand(self) -> CharacterState:
        """Draw a second or two of standing."""
        frames = self._stands[self._rng.integers(len(self._stands))]
        length = int(self._rng.integers(75, 130))
        start = int(self._rng.integers(0, max(1, frames.batch_shape[0] - length)))
        return frames[start : start + length]


def _faster(frames: CharacterState, speed: float) -> CharacterState:
    clip = clip_from_poses("", frames.root_pos_w.copy(), frames.root_quat_w.copy(), frames.joint_pos.copy())
    return at_speed(clip, speed).frames
