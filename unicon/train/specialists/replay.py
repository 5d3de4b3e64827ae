"""What the student learns from: states that were seen, and what their teachers would do, within a bound.

A ring of rows in half precision: raw observations (the student's normalisation still moves), actions and
values. Nothing of it is on the disk; a training that is gone on with fills it anew.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor

_LARGEST = 6e4
"""Half precision ends at 65504."""


class Lesson(NamedTuple):
    """Samples of the replay, B rows, in float32."""

    observations: Tensor
    """``(B, O)``, raw."""
    actions: Tensor
    """``(B, A)``: the teachers' means."""
    values: Tensor
    """``(B,)``: the teachers'."""


class Replay:
    """Room for as many samples as the memory allows; when it is full the oldest are overwritten."""

    def __init__(
        self, observation_size: int, action_size: int, megabytes: float, device: torch.device
    ) -> None:
        sample = 2 * (observation_size + action_size + 1)
        self.capacity = max(1, int(megabytes * 2**20) // sample)
        """Number of samples that fit in."""
        self.count = 0
        """Number of samples that are in it."""
        self._next = 0
        # the system gives the pages when they are written to
        self._observations = torch.empty(self.capacity, observation_size, dtype=torch.half, device=device)
        self._actions = torch.empty(self.capacity, action_size, dtype=torch.half, device=device)
        self._values = torch.empty(self.capacity, dtype=torch.half, device=device)

    @property
    def bytes(self) -> int:
        """Memory that it takes when it is full."""
        return sum(t.numel() * t.element_size() for t in (self._observations, self._actions, self._values))

    def add(self, lesson: Lesson) -> None:
        """Keep samples; of more than there is room for, the last."""
        lesson = Lesson(*(tensor[-self.capacity :] for tensor in lesson))
        first = min(len(lesson.values), self.capacity - self._next)
        self._write(self._next, Lesson(*(tensor[:first] for tensor in lesson)))
        self._write(0, Lesson(*(tensor[first:] for tensor in lesson)))
        self._next = (self._next + len(lesson.values)) % self.capacity
        self.count = min(self.capacity, self.count + len(lesson.values))

    def draw(self, count: int, generator: torch.Generator) -> Lesson:
        """Return ``count`` samples, each of all alike, with repetition."""
        device = self._values.device
        rows = torch.randint(self.count, (count,), generator=generator, device=device)
        return Lesson(
            *(t.index_select(0, rows).float() for t in (self._observations, self._actions, self._values))
        )

    def _write(self, at: int, lesson: Lesson) -> None:
        rows = slice(at, at + len(lesson.values))
        for room, tensor in zip((self._observations, self._actions, self._values), lesson, strict=True):
            room[rows].copy_(tensor.clamp(-_LARGEST, _LARGEST))
