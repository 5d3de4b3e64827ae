"""The phase of a walk, from when its feet touch down (Holden, Komura, Saito 2017, section 4.1).

The phase is 0 when the left foot touches down and pi when the right foot does; in between it rises evenly.
Of two touch-downs of the same foot in a row the second is a whole cycle on. Where feet rest for longer than
a slow step, as in standing, the phase waits at the last touch-down and goes on in the ``STEP_S`` before the
next: that is when the foot is lifted for it. After the last it stays. Touch-downs less than ``NEAREST_S``
after another are none of a step, as when both feet come to rest, and are left out; the corners that are left
are rounded.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon.motion.clip_index import RATE_HZ

SLOWEST_STEP_S = 0.9
"""A step that takes longer begins with a rest."""
NEAREST_S = 0.15
"""Two touch-downs are at least so far apart."""
AGAIN_S = 0.45
"""Two of the same foot with none of the other between them: sooner, the foot was only set down anew."""
ROUND_FRAMES = 4.0
STEP_S = 0.5
"""Duration of a step after a rest."""


def touch_downs(contact: np.ndarray) -> list[tuple[int, int]]:
    """Return the frames at which a foot comes down, with the foot (0 left, 1 right), in order.

    Args:
        contact: when each foot stands ``(T, 2)``; a foot that stands at first has not come down.
    """
    frames, feet = np.nonzero(contact[1:] & ~contact[:-1])
    events: list[tuple[int, int]] = []
    for frame, foot in sorted(zip(frames.tolist(), feet.tolist(), strict=True)):
        gap_s = (frame + 1 - events[-1][0]) / RATE_HZ if events else np.inf
        if gap_s >= (AGAIN_S if events and events[-1][1] == foot else NEAREST_S):
            events.append((frame + 1, foot))
    return events


def label_phases(contact: np.ndarray) -> np.ndarray:
    """Return the phase of each frame ``(T,)`` [rad], never falling: it counts on from cycle to cycle."""
    events = touch_downs(contact)
    if not events:
        return np.zeros(len(contact))
    times, values = [], []
    phase = math.pi * events[0][1]
    slowest, step = round(SLOWEST_STEP_S * RATE_HZ), round(STEP_S * RATE_HZ)
    before = None
    for frame, foot in events:
        if before is not None:
            advance = _advance(before[1], foot)
            cycle_steps = round(advance / math.pi)
            if frame - before[0] > slowest * cycle_steps:
                times.append(frame - step * cycle_steps)
                values.append(phase)
            phase += advance
        elif frame > step:
            times.append(frame - step)
            values.append(phase - math.pi)
        times.append(frame)
        values.append(phase)
        before = frame, foot
    first = values[0]
    offset = -2.0 * math.pi * math.floor(first / (2.0 * math.pi))
    phase_of_frames = np.interp(np.arange(len(contact)), times, values) + offset
    return gaussian_filter1d(phase_of_frames, ROUND_FRAMES, mode="nearest")


def _advance(last: int, foot: int) -> float:
    """Return by how much the phase rises from one touch-down to the next."""
    return 2.0 * math.pi if last == foot else math.pi
