"""Sixty ticks a second by absolute deadlines t0 + k/60 on a steady clock, and what came of it.

A tick that is late runs at once, and the next deadline stays where it was, so that no time is lost; when
the loop is 100 ms behind, the deadlines are set anew from now (a rebase). In slow motion they are set
anew at every late tick instead, and the times given to the simulation do not jump: it runs slower than
the world, but no tick of it is left out.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from unicon.target_frames import NS_PER_S


@dataclass(frozen=True)
class PacerConfig:
    """How the loop keeps time."""

    rate_hz: int = 60
    slow_motion: bool = False
    """Let simulated time slow down on a machine that cannot keep up."""
    rebase_after_s: float = 0.1
    """How far behind the deadlines are set anew."""
    window: int = 3600
    """Over how many ticks the statistics reach."""


class Percentiles(NamedTuple):
    """Median, 99th percentile and maximum [s]."""

    p50: float
    p99: float
    max: float


class TickStatistics(NamedTuple):
    """How the ticks of the last minute went."""

    ticks: int
    missed: int
    """Ticks that began after the next one's deadline, since the start."""
    rebases: int
    tick_s: Percentiles
    """What a tick's work takes."""
    jitter_s: Percentiles
    """How late ticks begin."""
    rate_hz: float
    """Over the last second or so of the steady clock."""
    real_time_factor: float
    """Simulated time over the steady clock's, over the same ticks."""


class Pacer:
    """Deadlines and statistics of one loop; ``clock_ns`` is a steady clock."""

    def __init__(
        self,
        config: PacerConfig = PacerConfig(),  # noqa: B008 - frozen
        start_time_ns: int = 0,
        clock_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self.config = config
        self._clock_ns = clock_ns
        self.ticks = self.missed = self.rebases = 0
        self._work_s = np.zeros(config.window)
        self._late_s = np.zeros(config.window)
        self._began_ns = np.zeros(config.window, dtype=np.int64)
        self._times_ns = np.zeros(config.window, dtype=np.int64)
        self._offset_ns = start_time_ns - clock_ns()
        self._first_deadline_ns = clock_ns()
        self._index = 0

    @property
    def deadline_ns(self) -> int:
        """When the coming tick is due, on the steady clock."""
        return self._first_deadline_ns + self._index * NS_PER_S // self.config.rate_hz

    @property
    def tick_time_ns(self) -> int:
        """Time of the coming tick, as the simulation and the messages see it."""
        return self.deadline_ns + self._offset_ns

    def remaining_s(self) -> float:
        """Return how long it is to the coming tick, negative when it is late."""
        return (self.deadline_ns - self._clock_ns()) / NS_PER_S

    def begin(self) -> bool:
        """Begin the coming tick; return whether the deadlines were set anew for it."""
        now_ns = self._clock_ns()
        late_ns = max(now_ns - self.deadline_ns, 0)
        period_ns = NS_PER_S // self.config.rate_hz
        self.missed += late_ns > period_ns
        limit_ns = period_ns if self.config.slow_motion else int(self.config.rebase_after_s * NS_PER_S)
        rebased = late_ns > limit_ns
        if rebased:
            self._rebase(now_ns)
        slot = self.ticks % self.config.window
        self._late_s[slot] = late_ns / NS_PER_S
        self._began_ns[slot] = now_ns
        self._times_ns[slot] = self.tick_time_ns
        return rebased

    def finish(self) -> None:
        """End the tick that was begun, and turn to the next."""
        slot = self.ticks % self.config.window
        self._work_s[slot] = (self._clock_ns() - self._began_ns[slot]) / NS_PER_S
        self.ticks += 1
        self._index += 1

    def resume(self) -> None:
        """Go on from now after a pause: the time of the pause is skipped."""
        self._first_deadline_ns, self._index = self._clock_ns(), 0

    def statistics(self) -> TickStatistics:
        """Return how the ticks of the window went."""
        count = min(self.ticks, self.config.window)
        if count == 0:
            nothing = Percentiles(0.0, 0.0, 0.0)
            return TickStatistics(0, 0, 0, nothing, nothing, 0.0, 1.0)
        last = (self.ticks - 1) % self.config.window
        first = (self.ticks - min(count, self.config.rate_hz + 1)) % self.config.window
        wall_s = max(self._began_ns[last] - self._began_ns[first], 1) / NS_PER_S
        simulated_s = (self._times_ns[last] - self._times_ns[first]) / NS_PER_S
        steps = min(count, self.config.rate_hz + 1) - 1
        return TickStatistics(
            ticks=self.ticks,
            missed=self.missed,
            rebases=self.rebases,
            tick_s=_percentiles(self._work_s[:count]),
            jitter_s=_percentiles(self._late_s[:count]),
            rate_hz=steps / wall_s if steps else 0.0,
            real_time_factor=simulated_s / wall_s if steps else 1.0,
        )

    def _rebase(self, now_ns: int) -> None:
        due_ns = self.deadline_ns
        self._first_deadline_ns, self._index = now_ns, 0
        self.rebases += 1
        if self.config.slow_motion:
            self._offset_ns -= now_ns - due_ns


def _percentiles(values: np.ndarray) -> Percentiles:
    p50, p99 = np.percentile(values, [50, 99])
    return Percentiles(float(p50), float(p99), float(values.max()))
