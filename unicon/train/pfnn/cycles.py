"""The steady part of a walk or run, repeated: one gait cycle that closes, played again and again.

Of all pairs of frames about a cycle apart, the pair is taken whose poses and velocities, seen from the root's
heading, differ least:

    d(i, j) = |q_i - q_j|^2 + (0.1 s)^2 |q'_i - q'_j|^2 + (10 / m)^2 |z_i - z_j|^2
"""

from __future__ import annotations

import numpy as np

from unicon import state
from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.inertialization import begin_after
from unicon.state import CharacterState

CYCLE_S = (0.55, 1.6)
"""Shortest and longest cycle of two steps."""
SEAM_S = 0.15


def find_cycle(frames: CharacterState) -> tuple[int, int] | None:
    """Return the first frame of a cycle and that after its last, None where the motion has none."""
    count = frames.batch_shape[0]
    shortest, longest = (round(limit * RATE_HZ) for limit in CYCLE_S)
    if count <= shortest:
        return None
    features = np.concatenate(
        [frames.joint_pos, 0.1 * frames.joint_vel, 10.0 * frames.root_pos_w[:, 2:]], axis=1
    )
    best: tuple[float, int, int] | None = None
    for length in range(shortest, min(longest, count - 1) + 1):
        distance = np.sum(np.square(features[length:] - features[:-length]), axis=1)
        first = int(distance.argmin())
        if best is None or distance[first] < best[0]:
            best = float(distance[first]), first, first + length
    return None if best is None else best[1:]


def loop(frames: CharacterState, seconds: float) -> CharacterState | None:
    """Return the cycle of a motion repeated for at least so long, None where it has none.

    The whole motion up to the cycle's end comes first, so that the beginning is kept.
    """
    cycle = find_cycle(frames)
    if cycle is None:
        return None
    path = frames[: cycle[1]]
    again = frames[cycle[0] : cycle[1]]
    while path.batch_shape[0] < seconds * RATE_HZ:
        path = state.concatenate([path, begin_after(again, path[-1], SEAM_S)])
    return path
