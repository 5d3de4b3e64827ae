"""Where the root jumps or spins as no person can, and where it is missing."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from unicon.motion.cleaning.body_paths import BodyPaths, turn_angles
from unicon.motion.grounding.smooth_change import spans

JUMP_SPEED = 4.0
"""The root's speed may differ by this much from that of the frames around [m/s]."""
LEAST_JUMP_M = 0.05
SPIN_SPEED = 26.0
"""A pelvis never turns faster [rad/s]: somersaults and pirouettes reach 15, hand-made spins 22 ..."""
LEAST_SPIN_RAD = np.radians(35)
"""... nor by this much within a frame or two ..."""
SPIN_S = 1 / 30
AROUND_S = 0.12
"""What is near such a place ..."""
AROUND_SPIN_SPEED = 8.0
"""... and still faster than this belongs to it [rad/s]."""
JOIN_S = 0.4
"""Places nearer to each other are one: what lies between them is not to be trusted."""


def root_jumps(paths: BodyPaths, kept: np.ndarray) -> list[tuple[int, int]]:
    """Return where the pelvis jumps or spins, as pairs of the first bad frame and the one after the last.

    A single jump before frame f is (f, f): no frame is bad, but the motion breaks there.

    Args:
        paths: T frames.
        kept: which of them count ``(T,)``.
    """
    pelvis = paths.parts["pelvis"]
    steps_s = np.diff(paths.times_s)
    both_kept = np.logical_and(kept[1:], kept[:-1])
    bad = _odd_steps(paths.pos_w[:, pelvis], steps_s) | _spins(paths.rot_w[:, pelvis], paths)
    bad &= both_kept
    if not bad.any():
        return []
    turn = turn_angles(paths.rot_w[:, pelvis]) / steps_s
    near = binary_dilation(bad, iterations=max(round(AROUND_S * paths.rate_hz), 1))
    bad |= np.logical_and.reduce([near, turn > AROUND_SPIN_SPEED, both_kept])
    gap = round(JOIN_S * paths.rate_hz)
    return [(start + 1, stop) for start, stop in _join(spans(bad), gap)]


def _join(stretches: list[tuple[int, int]], gap: int) -> list[tuple[int, int]]:
    joined: list[tuple[int, int]] = []
    for start, stop in stretches:
        if joined and start - joined[-1][1] < gap:
            start = joined.pop()[0]
        joined.append((start, stop))
    return joined


def _odd_steps(pos_w: np.ndarray, steps_s: np.ndarray) -> np.ndarray:
    """Return which steps ``(T-1,)`` differ from the mean of those two before and two after."""
    velocity = np.asarray(np.diff(pos_w, axis=0) / steps_s[:, None])
    if len(velocity) < 5:
        return np.zeros(len(velocity), dtype=bool)
    padded = np.pad(velocity, ((2, 2), (0, 0)), mode="reflect")
    around = np.median(np.stack([padded[:-4], padded[1:-3], padded[3:-1], padded[4:]]), axis=0)
    odd = np.linalg.norm(velocity - around, axis=-1)
    return np.asarray((odd > JUMP_SPEED) & (odd * steps_s > LEAST_JUMP_M))


def _spins(quat: np.ndarray, paths: BodyPaths) -> np.ndarray:
    """Return which steps ``(T-1,)`` belong to a turn that is too fast."""
    step = max(round(SPIN_S * paths.rate_hz), 1)
    if len(quat) <= step:
        return np.zeros(len(quat) - 1, dtype=bool)
    angle = turn_angles(quat, step)
    duration = paths.times_s[step:] - paths.times_s[:-step]
    fast = (angle > SPIN_SPEED * duration) & (angle > LEAST_SPIN_RAD)
    single = turn_angles(quat)
    inside = np.zeros(len(quat) - 1, dtype=bool)
    for offset in range(step):
        inside[offset : offset + len(fast)] |= fast
    return inside & (single > 0.5 * LEAST_SPIN_RAD / step)


def root_never_moves(paths: BodyPaths) -> bool:
    """Return whether the pelvis stays at one place to the tenth of a millimetre while the feet move."""
    return bool(
        np.ptp(paths.pos("pelvis"), axis=0).max() < 1e-4
        and np.ptp(paths.of(("left_foot", "right_foot")), axis=0).max() > 0.02
    )
