"""Finds the flights in a motion: where the body falls freely and nothing touches.

On the ground the centre of mass is held up; in flight it falls with 9.81 m/s^2. A stretch is a flight when
the centre of mass accelerates downwards by about that much, AND the lowest point rises above the straight
line between its heights at take-off and landing. Crouching fails the second test (the feet stay), a
body that lies or hangs too high fails the first. Neither needs to know where the floor is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.ndimage import grey_opening
from scipy.signal import savgol_filter

from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.smooth_change import spans

GRAVITY = 9.81
"""[m/s^2]"""


_LEVEL_M = 0.005
"""What rises less than this from one frame to the next is not taking off."""


@dataclass(frozen=True)
class FlightConfig:
    """What counts as a flight."""

    window_s: float = 0.15
    """Over how long the acceleration of the centre of mass is measured."""
    fall: float = 4.4
    """A flight falls faster than this somewhere [m/s^2] ..."""
    held: float = 1.5
    """... and lasts while it falls faster than this [m/s^2]."""
    too_fast: float = 20.0
    """What falls faster than this on the whole is a fault of the capture [m/s^2]."""
    shortest_s: float = 0.1
    """A shorter flight isn't one."""
    clearance_m: float = 0.01
    """How far the lowest point has to rise."""
    slow_clearance_m: float = 0.15
    """From this rise on, a jump may fall as slowly as hand-made ones do ..."""
    slow_misfit: float = 0.15
    """... if its height is a parabola's to within this share of its rise."""


class Flight(NamedTuple):
    """One flight."""

    start: int
    """First frame in the air."""
    stop: int
    """First frame back on the ground, or the number of frames."""
    acceleration: float
    """Of the centre of mass, by the best parabola [m/s^2]; -9.81 in a real flight."""


def find_flights(mass_height: np.ndarray, lowest: np.ndarray, config: FlightConfig) -> list[Flight]:
    """Return the flights in the heights ``(T,)`` of the centre of mass and of the lowest point [m]."""
    window = 2 * int(0.5 * config.window_s * RATE_HZ) + 1
    if len(lowest) <= window:
        return []
    acceleration = np.asarray(savgol_filter(mass_height, window, 2, deriv=2, delta=1 / RATE_HZ))
    found = [
        flight
        for start, stop in spans(acceleration < -config.held)
        if (acceleration[start:stop] < -config.fall).sum() >= 3
        and (flight := _judge(mass_height, lowest, start, stop, config)) is not None
    ]
    covered = air_frames(found, len(lowest))
    slow = [f for f in _slow_jumps(mass_height, lowest, config) if not covered[f.start : f.stop].any()]
    return sorted(found + slow)


def air_frames(flights: list[Flight], count: int) -> np.ndarray:
    """Return whether each frame ``(T,)`` is in a flight."""
    mask = np.zeros(count, dtype=bool)
    for flight in flights:
        mask[flight.start : flight.stop] = True
    return mask


def _judge(
    mass_height: np.ndarray, lowest: np.ndarray, start: int, stop: int, config: FlightConfig
) -> Flight | None:
    """Return the flight within a stretch that falls, if there is one."""
    first, last = _feet_of(lowest, max(start - 1, 0), min(stop, len(lowest) - 1), config)
    line = np.interp(np.arange(first, last + 1), [first, last], [lowest[first], lowest[last]])
    rise = lowest[first : last + 1] - line
    if rise.max() < config.clearance_m:
        return None
    off = np.flatnonzero(rise > 0.25 * config.clearance_m) + first
    start, stop = int(off[0]), int(off[-1]) + 1
    fitted, _ = _parabola(mass_height[start:stop])
    if stop - start < config.shortest_s * RATE_HZ - 1 or not -config.too_fast < fitted < -config.fall:
        return None
    return Flight(start, stop, fitted)


def _feet_of(lowest: np.ndarray, first: int, last: int, config: FlightConfig) -> tuple[int, int]:
    """Return where the rise of a stretch begins and ends: down each side by up to a quarter of the window.

    Measuring the acceleration over a window hides the first and last frames of a flight.
    """
    for _ in range(int(0.25 * config.window_s * RATE_HZ)):
        if first > 0 and lowest[first - 1] < lowest[first] - _LEVEL_M:
            first -= 1
        if last < len(lowest) - 1 and lowest[last + 1] < lowest[last] - _LEVEL_M:
            last += 1
    return first, last


def _slow_jumps(mass_height: np.ndarray, lowest: np.ndarray, config: FlightConfig) -> list[Flight]:
    """Return high jumps that fall too slowly: what rises for less than a second, as a parabola does."""
    rise = lowest - grey_opening(lowest, round(RATE_HZ) + 1)
    jumps = []
    for start, stop in spans(rise > 0.25 * config.slow_clearance_m):
        if rise[start:stop].max() < config.slow_clearance_m or stop - start < 6:
            continue
        fitted, misfit = _parabola(mass_height[start:stop])
        if -config.too_fast < fitted < -config.held and misfit < config.slow_misfit:
            jumps.append(Flight(start, stop, fitted))
    return jumps


def _parabola(heights: np.ndarray) -> tuple[float, float]:
    """Return the acceleration [m/s^2] of the parabola nearest to some heights, and its misfit.

    The misfit is the largest distance from it as a share of how far it curves.
    """
    if len(heights) < 4:
        return 0.0, np.inf
    times = np.arange(len(heights)) / RATE_HZ
    curve = np.polynomial.Polynomial.fit(times, heights, 2)
    acceleration = float(curve.deriv(2)(0.0))
    rise = abs(acceleration) * times[-1] ** 2 / 8
    return acceleration, float(np.abs(curve(times) - heights).max() / max(rise, 1e-9))
