"""Stitching: clips one after the other, each going on where the last one ended.

A clip is turned and shifted along the ground so that it begins in the place and heading where the path
ends, and what it differs by fades away over a transition (``inertialization.py``). When
nothing is queued, the path goes on with what the stitcher is told to ask for the next clip; where that has
none, it goes over into a standing pose and stays there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from unicon import state
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip import RATE_HZ, Clip, continuous_signs
from unicon.schedulers.inertialization import begin_after
from unicon.state import CharacterState, differentiate
from unicon.target_frames import NS_PER_S

MAX_TRANSITION_S = 5.0
KEPT_FRAMES = 120
"""Frames of the path that are kept after they were sent."""


@dataclass(frozen=True)
class StitcherConfig:
    """How clips are joined and sent."""

    window: int = 8
    """Frames in each window that is sent."""
    transition_s: float = 0.8
    """Length of a transition where none is given, and of that into standing."""


class Window(NamedTuple):
    """What to send now."""

    time_ns: int
    """Time of the first frame."""
    frames: CharacterState
    """Batch ``(window,)`` at 60 Hz."""


class Segment(NamedTuple):
    """One clip's part of the path; an empty name is standing."""

    name: str
    start: int
    stop: int


class _Queued(NamedTuple):
    clip: Clip
    transition_s: float


class Stitcher:
    """A first-in, first-out queue of clips as one endless path, from ``start_ns`` on.

    ``next_clip`` is asked for a clip whenever the path ends and nothing waits; None means to stand.
    """

    def __init__(
        self,
        config: StitcherConfig,
        start_ns: int,
        next_clip: Callable[[], Clip | None] = lambda: None,
    ) -> None:
        self.config = config
        self._start_ns = start_ns
        self._next_clip = next_clip
        self._queue: deque[_Queued] = deque()
        standing = HUMANOID.rest_state()
        self._path = state.stack([standing, standing])
        self._first = 0
        self._segments: list[Segment] = [Segment("", 0, 2)]
        self._sent = 0

    @property
    def queued(self) -> list[str]:
        """Names of the clips that wait."""
        return [entry.clip.name for entry in self._queue]

    @property
    def playing(self) -> Segment:
        """The segment of the last frame that was sent first."""
        return next((s for s in self._segments if s.start <= self._sent < s.stop), self._segments[-1])

    @property
    def position_s(self) -> float:
        """Time within the segment that is playing."""
        return max(self._sent - self.playing.start, 0) / RATE_HZ

    @property
    def empty(self) -> bool:
        """Whether nothing is playing or queued: it stands."""
        return not self._queue and not self.playing.name

    def queue(self, clip: Clip, transition_s: float) -> None:
        """Append a clip; a negative transition takes the default.

        Raises:
            UniconError: when the transition is too long or not a number.
        """
        length_s = self.config.transition_s if transition_s < 0 else transition_s
        if not length_s <= MAX_TRANSITION_S:
            raise UniconError(f"the transition is {length_s} s, expected 0 to {MAX_TRANSITION_S:g}")
        self._queue.append(_Queued(clip, length_s))

    def clear(self) -> None:
        """Forget what waits and what was not sent yet; the path goes on from there with what is next."""
        self._queue.clear()
        last = self._sent + self.config.window
        if last < self._stop and self._segments[-1].name:
            self._path = self._path[: last - self._first]
            kept = [s for s in self._segments if s.start < last]
            self._segments = [*kept[:-1], kept[-1]._replace(stop=last)]

    def next_frames(self, time_ns: int) -> Window:
        """Return the window of frames that begins one frame after ``time_ns``."""
        index = round((time_ns - self._start_ns) * RATE_HZ / NS_PER_S) + 1
        self._sent = max(index, self._first)
        while self._stop < self._sent + self.config.window:
            self._extend()
        self._forget()
        first = self._sent - self._first
        frames = self._path[first : first + self.config.window]
        return Window(self._start_ns + round(self._sent * NS_PER_S / RATE_HZ), frames)

    @property
    def _stop(self) -> int:
        return self._first + self._path.batch_shape[0]

    def _extend(self) -> None:
        if entry := self._take_next():
            self._append(entry.clip.frames, entry.transition_s, entry.clip.name)
        elif self._segments[-1].name:
            seconds = self.config.transition_s
            self._append(_standing(seconds), seconds, "")
        else:
            stop = self._stop + self.config.window
            more = state.stack([state.hold(self._path[-1])] * self.config.window)
            self._path = state.concatenate([self._path, more])
            self._segments[-1] = self._segments[-1]._replace(stop=stop)

    def _take_next(self) -> _Queued | None:
        if self._queue:
            return self._queue.popleft()
        clip = self._next_clip()
        return None if clip is None else _Queued(clip, self.config.transition_s)

    def _append(self, frames: CharacterState, transition_s: float, name: str) -> None:
        placed = begin_after(frames, self._path[-1], transition_s)
        start = self._stop
        joined = _with_velocities(state.concatenate([self._path[-2:], placed]))
        self._path = state.concatenate([self._path[:-1], joined[1:]])
        self._segments.append(Segment(name, start, self._stop))

    def _forget(self) -> None:
        surplus = self._sent - KEPT_FRAMES - self._first
        if surplus > KEPT_FRAMES:
            self._path, self._first = self._path[surplus:], self._first + surplus
            self._segments = [s for s in self._segments if s.stop > self._first]


def _repeat(frame: CharacterState, count: int) -> CharacterState:
    return CharacterState(*(np.repeat(value[None], count, axis=0) for value in vars(frame).values()))


def _with_velocities(frames: CharacterState) -> CharacterState:
    quat = continuous_signs(frames.root_quat_w)
    return differentiate(frames.root_pos_w, quat, frames.joint_pos, RATE_HZ)


def _standing(seconds: float) -> CharacterState:
    """Return so long a time in the rest pose, and a little more."""
    return _repeat(HUMANOID.rest_state(), round(seconds * RATE_HZ) + 3)
