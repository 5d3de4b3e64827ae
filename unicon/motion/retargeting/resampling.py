"""Brings a motion to 60 Hz: spherical cubic interpolation, after a short average where the source is faster.

Between two frames a joint turns from q0 to q1 = q0 exp(phi). With the angular velocities w0, w1 at both
(the mean of the turns before and after), the way between is q0 exp(r(t)), r a cubic with r(0) = 0, r(1)
= phi, r'(0) = w0 and r'(1) = w1 (Kim, Kim and Shin 1995 in the form of Hermite): velocities are
continuous, and a steady turn stays steady. Positions take the same cubic. At the ends velocities are
extrapolated, so that a clip begins and ends as fast as it goes on.

A source of more than 60 Hz is first averaged over its neighbours (1, 2, 1) / 4, once for each doubling,
which keeps what is slower than 15 Hz and takes away the jitter that would alias. It is symmetric, so
nothing lags.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.source_motion import SourceMotion

FAST_HZ = 1.5 * RATE_HZ
"""Sources faster than this are averaged before they are sampled."""


def resample(motion: SourceMotion) -> SourceMotion:
    """Return the motion at 60 Hz, its time beginning at zero.

    Raises:
        InputFileError: when it is shorter than two frames of 60 Hz.
    """
    times = motion.times_s - motion.times_s[0]
    count = int(np.floor(times[-1] * RATE_HZ + 1e-6)) + 1
    if count < 2:
        raise InputFileError(f"{motion.name}: lasts {times[-1]:.3f} s, too short for a clip")
    quat, root, local = motion.local_quat, motion.root_pos, motion.local_pos
    source_hz = (len(times) - 1) / times[-1]
    while source_hz > FAST_HZ and len(times) > 2:
        quat, root = _average_turns(quat), _average(root)
        local = None if local is None else _average(local)
        source_hz /= 2.0
    new_times = np.arange(count) / RATE_HZ
    left = np.clip(np.searchsorted(times, new_times, side="right") - 1, 0, len(times) - 2)
    share = np.clip((new_times - times[left]) / (times[left + 1] - times[left]), 0.0, 1.0)
    steps_s = np.diff(times)
    return replace(
        motion,
        times_s=new_times,
        local_quat=_interpolate_turns(quat, steps_s, left, share),
        root_pos=_interpolate(root, steps_s, left, share),
        local_pos=None if local is None else _interpolate(local, steps_s, left, share),
    )


def _average(values: np.ndarray) -> np.ndarray:
    """Return ``(T, ...)`` averaged over neighbours; the ends stay, so that their speed does."""
    averaged = values.copy()
    averaged[1:-1] = 0.25 * (values[:-2] + 2.0 * values[1:-1] + values[2:])
    return averaged


def _average_turns(quat: np.ndarray) -> np.ndarray:
    """Return rotations ``(T, J, 4)`` averaged over neighbours."""
    middle = quat[1:-1]
    averaged = quat.copy()
    averaged[1:-1] = rotations.normalize(
        2.0 * middle + _same_side(quat[:-2], middle) + _same_side(quat[2:], middle)
    )
    return averaged


def _same_side(quat: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the rotations with the sign that is nearer to ``other``."""
    return np.where(np.sum(quat * other, axis=-1, keepdims=True) < 0.0, -quat, quat)


def _interpolate_turns(
    quat: np.ndarray, steps_s: np.ndarray, left: np.ndarray, share: np.ndarray
) -> np.ndarray:
    phi = rotations.to_rotation_vector(rotations.multiply(rotations.conjugate(quat[:-1]), quat[1:]))
    velocity = _velocities(phi, steps_s)
    way = _hermite(phi, velocity, steps_s, left, share)
    return rotations.multiply(quat[left], rotations.from_rotation_vector(way))


def _interpolate(values: np.ndarray, steps_s: np.ndarray, left: np.ndarray, share: np.ndarray) -> np.ndarray:
    change = np.diff(values, axis=0)
    return values[left] + _hermite(change, _velocities(change, steps_s), steps_s, left, share)


def _velocities(change: np.ndarray, steps_s: np.ndarray) -> np.ndarray:
    """Return velocities ``(T, ...)`` at the frames, given the changes ``(T - 1, ...)`` between them.

    In the middle the slope of the parabola through three frames, at the ends that of the one beside them.
    """
    steps = steps_s.reshape(-1, *(1,) * (change.ndim - 1))
    rates = change / steps
    if len(rates) == 1:
        return np.repeat(rates, 2, axis=0)
    before, after = steps[:-1], steps[1:]
    middle = (rates[:-1] * after + rates[1:] * before) / (before + after)
    first, last = 2.0 * rates[:1] - middle[:1], 2.0 * rates[-1:] - middle[-1:]
    return np.concatenate([first, middle, last])


def _hermite(
    change: np.ndarray, velocity: np.ndarray, steps_s: np.ndarray, left: np.ndarray, share: np.ndarray
) -> np.ndarray:
    """Return the cubic's way from the frame on the left."""
    shape = (-1, *(1,) * (change.ndim - 1))
    t, step = share.reshape(shape), steps_s[left].reshape(shape)
    whole = t * t * (3.0 - 2.0 * t)
    return (
        whole * change[left]
        + step * t * (1.0 - t) ** 2 * velocity[left]
        - step * t * t * (1.0 - t) * velocity[left + 1]
    )
