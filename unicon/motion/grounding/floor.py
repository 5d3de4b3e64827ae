"""Puts a motion on the floor: its lowest point at z = 0 while something touches, a free fall in flight.

The floor under a motion is wherever its lowest point is, whether that drifts, slopes or jumps because a
pose doesn't fit: the root's height changes so that the lowest point is at z = 0, whatever body it is on.
In flight it changes so that the centre of mass falls with 9.81 m/s^2 between take-off and landing. Both
come out of one least-squares problem, whose answer is the smallest smooth change.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.flight import GRAVITY, Flight, air_frames
from unicon.motion.grounding.smooth_change import SmoothChange


@dataclass(frozen=True)
class FloorConfig:
    """How the height is corrected."""

    smoothness: float = 30.0
    """Weight of the change's second differences against its errors; 30 smooths over about 0.1 s."""
    sunk_weight: float = 10.0
    """Weight of a frame that is below the floor, against one above it."""
    rounds: int = 4
    """How often the frames below the floor are looked for."""
    largest_lift_m: float = 0.1
    """A flight that is too slow is made higher (one that is too fast, lower) by no more than this."""


def height_change(
    lowest: np.ndarray, mass_height: np.ndarray, flights: list[Flight], config: FloorConfig
) -> np.ndarray:
    """Return what to add to the root's height ``(T,)`` [m].

    Args:
        lowest: height of the lowest point ``(T,)`` [m].
        mass_height: height of the centre of mass ``(T,)`` [m].
        flights: where the body is in the air.
        config: how much is asked of the change.
    """
    air = air_frames(flights, len(lowest))
    frames = np.arange(len(lowest))
    ground = lowest if air.all() else np.interp(frames, frames[~air], lowest[~air])
    weight = np.where(air, 1e-5, 1.0)
    for _ in range(config.rounds):
        change = _solve(weight, -ground, mass_height, flights, config)
        sunk = ~air & (lowest + change < 0.0)
        weight = np.where(air, 1e-5, np.where(sunk, config.sunk_weight, 1.0))
    return change


def _solve(
    weight: np.ndarray,
    wanted: np.ndarray,
    mass_height: np.ndarray,
    flights: list[Flight],
    config: FloorConfig,
) -> np.ndarray:
    bends, stiffness = np.zeros(len(wanted) - 2), np.full(len(wanted) - 2, config.smoothness)
    own = np.diff(mass_height, 2)
    for flight in flights:
        inner = slice(max(flight.start - 1, 0), flight.stop - 1)
        bends[inner] = _wanted_fall(flight, config.largest_lift_m) / RATE_HZ**2 - own[inner]
        stiffness[inner] = 1e3 * config.smoothness
    problem = SmoothChange(len(wanted))
    problem.want_values(weight, wanted)
    problem.want_bends(stiffness, bends)
    return problem.solve()[:, 0]


def _wanted_fall(flight: Flight, largest_lift_m: float) -> float:
    """Return the acceleration [m/s^2] to give a flight.

    Over a time T another acceleration raises the middle by (difference) T^2 / 8.
    """
    duration_s = (flight.stop - flight.start + 1) / RATE_HZ
    largest = 8 * largest_lift_m / duration_s**2
    return flight.acceleration + float(np.clip(-GRAVITY - flight.acceleration, -largest, largest))
