"""Tests for pacing.py, on a clock that the tests turn."""

from __future__ import annotations

import numpy as np

from unicon.pacing import Pacer, PacerConfig

TICK_NS = 1_000_000_000 // 60


class Clock:
    """A clock that stands still until it is told."""

    def __init__(self) -> None:
        self.now_ns = 10**12

    def __call__(self) -> int:
        return self.now_ns


def make(**config) -> tuple[Pacer, Clock]:
    clock = Clock()
    return Pacer(PacerConfig(**config), start_time_ns=5 * 10**18, clock_ns=clock), clock


def run(pacer: Pacer, clock: Clock, work_ns: list[int]) -> list[int]:
    """Do ticks that take so long; return their times."""
    times = []
    for duration in work_ns:
        clock.now_ns = max(clock.now_ns, pacer.deadline_ns)
        pacer.begin()
        times.append(pacer.tick_time_ns)
        clock.now_ns += duration
        pacer.finish()
    return times


def test_sixty_ticks_take_a_second_to_the_nanosecond():
    pacer, clock = make()
    times = run(pacer, clock, [1_000_000] * 61)
    assert times[60] - times[0] == 10**9
    assert times[0] == 5 * 10**18
    assert pacer.missed == 0


def test_a_late_tick_is_counted_and_the_next_deadline_stays():
    pacer, clock = make()
    times = run(pacer, clock, [50_000_000, 0, 0, 0, 0, 0])
    assert pacer.missed == 2
    assert pacer.rebases == 0
    assert np.all(np.abs(np.diff(times) - 1e9 / 60) <= 1)


def test_after_a_tenth_of_a_second_the_clock_is_set_anew():
    pacer, clock = make()
    times = run(pacer, clock, [200_000_000, 0, 0])
    assert pacer.rebases == 1
    assert times[1] - times[0] == 200_000_000
    assert np.isclose(times[2] - times[1], 1e9 / 60, atol=1)


def test_in_slow_motion_no_time_is_skipped_and_the_factor_says_so():
    pacer, clock = make(slow_motion=True)
    times = run(pacer, clock, [2 * TICK_NS + 5_000_000] * 100)
    assert np.all(np.abs(np.diff(times) - 1e9 / 60) <= 2)
    assert 0.3 < pacer.statistics().real_time_factor < 0.5


def test_a_pause_is_skipped():
    pacer, clock = make()
    run(pacer, clock, [0] * 5)
    clock.now_ns += 10 * 10**9
    pacer.resume()
    assert pacer.remaining_s() == 0.0
    before = pacer.missed
    run(pacer, clock, [0])
    assert pacer.missed == before


def test_the_statistics_are_those_of_the_ticks():
    pacer, clock = make(window=100)
    run(pacer, clock, [2_000_000] * 99 + [9_000_000])
    statistics = pacer.statistics()
    assert np.isclose(statistics.tick_s.p50, 0.002)
    assert np.isclose(statistics.tick_s.max, 0.009)
    assert np.isclose(statistics.rate_hz, 60.0, rtol=1e-3)
    assert np.isclose(statistics.real_time_factor, 1.0, rtol=1e-3)


def test_before_the_first_tick_there_is_nothing_to_say():
    pacer, _ = make()
    assert pacer.statistics().ticks == 0
