"""Several sources of targets, of which one is followed: chosen by name, or whichever began last.

A source is live while messages come at least every half second, and begins with its first message after
a silence. A source that is newly followed is anchored: turned and shifted along the ground so that it
goes on from the avatar's present place and heading, and blended in from what was followed before.

All times are those of ticks, never of a clock: the same messages between the same ticks give the same
targets.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from unicon import rotations, state
from unicon.state import CharacterState
from unicon.target_buffer import BufferConfig, TargetBuffer
from unicon.target_frames import NS_PER_S, RejectedTargetsError, RejectReason, TargetFrames


@dataclass(frozen=True)
class SourcesConfig:
    """When sources are live, and how one follows another."""

    live_s: float = 0.5
    """A source that was not heard for longer is silent."""
    blend_s: float = 0.25
    """How long the change from one source to another takes; 0 for at once."""
    max_sources: int = 32
    """Most sources that are remembered; beyond it, the one that was silent longest goes."""
    buffer: BufferConfig = field(default_factory=BufferConfig)


@dataclass(frozen=True)
class Anchor:
    """A turn about the vertical and a shift along the ground."""

    heading_rad: np.ndarray
    offset_w: np.ndarray
    """``(3,)`` [m]."""

    def apply(self, frames: CharacterState) -> CharacterState:
        """Return the frames as anchored."""
        return state.move(frames, self.heading_rad, self.offset_w)


def anchor_at(source: CharacterState, avatar: CharacterState) -> Anchor:
    """Return the anchor that brings the root of ``source`` to the avatar's place and heading."""
    turn = rotations.heading_angle(avatar.root_quat_w) - rotations.heading_angle(source.root_quat_w)
    turned = rotations.rotate(rotations.from_heading(turn), source.root_pos_w)
    offset_w = (avatar.root_pos_w - turned) * np.array([1.0, 1.0, 0.0])
    return Anchor(turn, offset_w)


@dataclass
class _Source:
    buffer: TargetBuffer
    sequence: int
    heard_ns: int
    began: int
    """Rank among all beginnings: the highest began last."""


@dataclass(frozen=True)
class _Followed:
    """A source that is followed since a tick."""

    name: str
    began: int
    anchor: Anchor


class TargetSources:
    """All sources and the choice among them."""

    def __init__(self, config: SourcesConfig = SourcesConfig()) -> None:  # noqa: B008 - frozen
        self.config = config
        self.selected = ""
        """Name of the source to follow; empty for whichever began last."""
        self._sources: dict[str, _Source] = {}
        self._beginnings = 0
        self._followed: _Followed | None = None
        self._before: _Followed | None = None
        self._held: CharacterState | None = None
        self._last: CharacterState | None = None
        self._switched_ns = 0

    @property
    def source(self) -> str:
        """Name of the source that is followed, empty when there is none."""
        return self._followed.name if self._followed else ""

    def live(self, now_ns: int) -> list[str]:
        """Return the names of the sources that are live."""
        return sorted(name for name, s in self._sources.items() if self._is_live(s, now_ns))

    def is_live(self, now_ns: int) -> bool:
        """Return whether the followed source is live."""
        return self.source in self._sources and self._is_live(self._sources[self.source], now_ns)

    def offer(self, targets: TargetFrames, now_ns: int) -> None:
        """Take in a sound message that came at the tick time ``now_ns``.

        Raises:
            RejectedTargetsError: when its sequence is not newer than the source's last one.
        """
        known = self._sources.get(targets.source)
        if known is None or not self._is_live(known, now_ns):
            known = self._begin(targets.source)
        elif targets.sequence <= known.sequence:
            raise RejectedTargetsError(
                RejectReason.OLD_SEQUENCE,
                f"{targets.source!r} sent {targets.sequence} after {known.sequence}",
            )
        known.buffer.add(targets)
        known.sequence, known.heard_ns = targets.sequence, now_ns

    def sample(self, times_ns: np.ndarray, now_ns: int, avatar: CharacterState) -> CharacterState | None:
        """Return the targets at ``times_ns (K,)`` as anchored and blended, None where no source came yet."""
        self._choose(times_ns, now_ns, avatar)
        if self._followed is None:
            return None
        frames = self._sample_of(self._followed, times_ns)
        blended_s = (times_ns - self._switched_ns) / NS_PER_S
        if self._held is None or blended_s[0] >= self.config.blend_s:
            self._before = self._held = None
            return frames
        weight = np.clip(blended_s / max(self.config.blend_s, 1e-9), 0.0, 1.0)
        return state.interpolate(self._outgoing(times_ns), frames, weight)

    def remember(self, target: CharacterState) -> None:
        """Keep the target of this tick: a change of source blends from it."""
        self._last = target

    def _is_live(self, source: _Source, now_ns: int) -> bool:
        return now_ns - source.heard_ns <= self.config.live_s * NS_PER_S

    def _begin(self, name: str) -> _Source:
        self._beginnings += 1
        if name not in self._sources and len(self._sources) >= self.config.max_sources:
            spare = [n for n in self._sources if n != self.source]
            del self._sources[min(spare, key=lambda n: self._sources[n].heard_ns)]
        self._sources[name] = _Source(TargetBuffer(self.config.buffer), -1, 0, self._beginnings)
        return self._sources[name]

    def _wanted(self, now_ns: int) -> str:
        if self.selected:
            return self.selected if self.selected in self._sources else ""
        live = self.live(now_ns)
        return max(live, key=lambda n: self._sources[n].began) if live else self.source

    def _choose(self, times_ns: np.ndarray, now_ns: int, avatar: CharacterState) -> None:
        name = self._wanted(now_ns)
        if name not in self._sources:
            return
        began = self._sources[name].began
        if self._followed and (self._followed.name, self._followed.began) == (name, began):
            return
        frame = self._sources[name].buffer.sample(times_ns[:1]).frames[0]
        self._before, self._held = self._followed, self._last
        self._followed = _Followed(name, began, anchor_at(frame, avatar))
        self._switched_ns = now_ns

    def _sample_of(self, followed: _Followed, times_ns: np.ndarray) -> CharacterState:
        return followed.anchor.apply(self._sources[followed.name].buffer.sample(times_ns).frames)

    def _outgoing(self, times_ns: np.ndarray) -> CharacterState:
        """Return what was followed before: it goes on while its source is known, else its last pose."""
        before = self._before
        if before and before.name in self._sources and self._sources[before.name].began == before.began:
            return self._sample_of(before, times_ns)
        assert self._held is not None
        return state.hold(state.stack([self._held] * len(times_ns)))
