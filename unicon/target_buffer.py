"""The target frames of one source by time.

Between two frames it interpolates, past the last it extrapolates, then it holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from unicon import state
from unicon.state import CharacterState
from unicon.target_frames import FRAME_SIZE, NS_PER_S, TargetFrames, pack, unpack


@dataclass(frozen=True)
class BufferConfig:
    """How far a buffer reaches."""

    extrapolate_s: float = 0.05
    """How long targets go on with their velocities when no newer ones come; then they are held."""
    keep_s: float = 0.25
    """How much of the past is kept, for a blend from this source to another."""
    max_frames: int = 4096
    """Most frames that are kept; beyond it the oldest go."""


class TargetSample(NamedTuple):
    """Targets at the times asked for."""

    frames: CharacterState
    """Batch ``(K,)``."""
    held: np.ndarray
    """``(K,)`` bool: the time lies outside of what is known, and the pose is held."""


class TargetBuffer:
    """Frames at rising times; a newer message replaces all from its first frame on."""

    def __init__(self, config: BufferConfig = BufferConfig()) -> None:  # noqa: B008 - frozen
        self.config = config
        self._times_ns = np.zeros(0, dtype=np.int64)
        self._rows = np.zeros((0, FRAME_SIZE))
        self._sampled_ns: int | None = None

    def __len__(self) -> int:
        return len(self._times_ns)

    def add(self, targets: TargetFrames) -> None:
        """Take in a message, and forget what lies too far in the past."""
        last = int(np.searchsorted(self._times_ns, targets.times_ns[0], side="left"))
        first = 0
        if self._sampled_ns is not None:
            oldest = self._sampled_ns - int(self.config.keep_s * NS_PER_S)
            first = max(0, int(np.searchsorted(self._times_ns, oldest, side="right")) - 1)
        first = min(first, last)
        self._times_ns = np.concatenate([self._times_ns[first:last], targets.times_ns])
        self._rows = np.concatenate([self._rows[first:last], pack(targets.frames)])
        excess = len(self._times_ns) - self.config.max_frames
        if excess > 0:
            self._times_ns, self._rows = self._times_ns[excess:], self._rows[excess:]

    def sample(self, times_ns: np.ndarray) -> TargetSample:
        """Return the targets at ``times_ns (K,)``, rising.

        Raises:
            ValueError: when the buffer is empty.
        """
        if not len(self):
            raise ValueError("an empty buffer has no targets")
        self._sampled_ns = int(times_ns[0])
        early = times_ns < self._times_ns[0]
        late_s = np.maximum(times_ns - self._times_ns[-1], 0) / NS_PER_S
        frames = self._between(times_ns)
        if late_s.any():
            reach_s = np.minimum(late_s, self.config.extrapolate_s)
            frames = state.extrapolate(frames, reach_s)
        held = early | (late_s > self.config.extrapolate_s)
        if held.any():
            frames = _stop(frames, held)
        return TargetSample(frames, held)

    def _between(self, times_ns: np.ndarray) -> CharacterState:
        after = np.searchsorted(self._times_ns, times_ns, side="right")
        left = np.clip(after - 1, 0, len(self) - 1)
        right = np.clip(after, 0, len(self) - 1)
        span = np.maximum(self._times_ns[right] - self._times_ns[left], 1)
        share = np.clip((times_ns - self._times_ns[left]) / span, 0.0, 1.0)
        if not share.any():
            return unpack(self._rows[left])
        return state.interpolate(unpack(self._rows[left]), unpack(self._rows[right]), share)


def _stop(frames: CharacterState, held: np.ndarray) -> CharacterState:
    """Return the frames with zero velocities where they are held."""
    moving = np.where(held, 0.0, 1.0)[:, None]
    return CharacterState(
        root_pos_w=frames.root_pos_w,
        root_quat_w=frames.root_quat_w,
        root_lin_vel_w=frames.root_lin_vel_w * moving,
        root_ang_vel_w=frames.root_ang_vel_w * moving,
        joint_pos=frames.joint_pos,
        joint_vel=frames.joint_vel * moving,
    )
