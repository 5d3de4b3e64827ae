"""Whether a file's frame rate is that of the capture: by the index, by falling, and by the pace of walking.

A body in the air falls with 9.81 m/s^2. A file whose rate is k times too high shows k^2 times as much. Where
nothing flies, a walk tells: with one foot always on the ground nobody takes more than three steps a second.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from unicon.motion.cleaning.body_paths import BodyPaths
from unicon.motion.cleaning.support import mass_centre
from unicon.motion.grounding.flight import GRAVITY
from unicon.motion.grounding.smooth_change import spans

FACTORS = (0.25, 0.5, 2.0, 4.0)
"""By what files are wrong."""
CLEARANCE_M = 0.08
"""Lowest joint over its lowest place within a second, in flight."""
SHORTEST_FLIGHT = 5
"""In frames."""
MISFIT = 0.08
"""Of the best parabola, as a share of its height."""
EVIDENCE = 0.2
"""How near the logarithm of the measured factor has to be to that of a listed one."""
WALK_SPEED, WALK_STEPS_HZ, FROUDE = 1.5, 3.1, 0.6
"""A walk that is faster in all three is played too fast: [m/s], steps a second, speed^2 / (9.81 leg)."""
GLIDE_SHARE = 0.05
"""In a walk both feet are faster than half the body for no more than this share of the time."""


class RateEvidence(NamedTuple):
    """What the motion says of its rate."""

    factor: float | None
    """What to multiply the rate by, 1 where it is right; None where nothing tells."""
    text: str = ""
    """The figure."""


def rate_evidence(paths: BodyPaths, falls: bool = True) -> RateEvidence:
    """Return by how much the rate is wrong; without ``falls`` what looks like flying doesn't count."""
    fall = falling(paths) if falls else None
    if fall is not None:
        return _judge_fall(fall)
    pace = walking_pace(paths)
    if pace is None:
        return RateEvidence(None)
    speed, steps_hz = pace
    fast = speed > WALK_SPEED and steps_hz > WALK_STEPS_HZ and speed**2 > FROUDE * GRAVITY * paths.leg_m
    text = f"it walks {speed:.1f} m/s with {steps_hz:.1f} steps a second, one foot always down"
    return RateEvidence(0.5 if fast else None, text)


def _judge_fall(fall: float) -> RateEvidence:
    factor = float(np.sqrt(GRAVITY / fall))
    nearest = min((1.0, *FACTORS), key=lambda known: abs(np.log(factor / known)))
    sure = abs(np.log(factor / nearest)) < EVIDENCE
    return RateEvidence(nearest if sure else None, f"in flight it falls with {fall:.1f} m/s^2")


def falling(paths: BodyPaths) -> float | None:
    """Return the acceleration [m/s^2] with which the centre of mass falls in flights; None without any.

    The median over flights, each by the best parabola through its height.
    """
    lowest = paths.pos_w[:, paths.body_rows, 2].min(axis=1)
    height = mass_centre(paths)[:, 2]
    window = 2 * round(0.5 * paths.rate_hz) + 1
    rise = lowest - minimum_filter1d(lowest, window, mode="nearest")
    found = []
    for start, stop in spans(rise > CLEARANCE_M):
        if stop - start < SHORTEST_FLIGHT or start == 0 or stop == len(lowest):
            continue
        times = paths.times_s[start:stop] - paths.times_s[start]
        curve = np.polynomial.Polynomial.fit(times, height[start:stop], 2)
        fall = -float(curve.deriv(2)(0.0))
        arch = fall * times[-1] ** 2 / 8
        if fall > 0.5 and arch > 0.02 and np.abs(curve(times) - height[start:stop]).max() < MISFIT * arch:
            found.append(fall)
    return float(np.median(found)) if found else None


def walking_pace(paths: BodyPaths) -> tuple[float, float] | None:
    """Return speed [m/s] and steps a second of a walk; None where it is something else."""
    root = paths.pos("pelvis")[:, :2]
    smooth = max(round(0.5 * paths.rate_hz), 1)
    if len(root) < 3 * smooth:
        return None
    velocity = (root[smooth:] - root[:-smooth]) / (paths.times_s[smooth:] - paths.times_s[:-smooth])[:, None]
    speed = np.linalg.norm(velocity, axis=-1)
    going = speed > 0.5
    if going.mean() < 0.5:
        return None
    first = smooth // 2
    feet = paths.of(("left_foot", "right_foot"))[first : first + len(speed)]
    foot_speed = np.linalg.norm(np.gradient(feet, axis=0), axis=-1) * paths.rate_hz
    gliding = (foot_speed.min(axis=1) > 0.5 * speed) & going
    if gliding.sum() > GLIDE_SHARE * going.sum():
        return None
    ahead = np.sum((feet[:, 0] - feet[:, 1])[:, :2] * velocity, axis=-1)[going]
    crossings = int(np.count_nonzero(np.diff(np.signbit(ahead))))
    steps_hz = crossings / (going.sum() / paths.rate_hz)
    return (float(np.median(speed[going])), steps_hz) if crossings >= 3 else None
