"""Leans a made motion into what was made of it: nobody takes a bend upright, and no policy could follow.

The line from the feet to the middle of the body has to point along gravity and acceleration together. A
motion that was bent or put together accelerates as the captured ones did not; by that difference a, smoothed
over a step, the body is tipped as a whole about the ground below its root:

    angle = atan(|a| / g),    towards a

Afterwards the feet have to be planted again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon import rotations
from unicon.motion.clip_index import RATE_HZ
from unicon.state import CharacterState
from unicon.train.pfnn.synthesis import with_velocities

GRAVITY_M_S2 = 9.81
_SMOOTH_FRAMES = 12.0
"""Deviation of the Gaussian: a step of walking, 0.5 s, leaves 4 % of its own acceleration."""


def acceleration_h(frames: CharacterState) -> np.ndarray:
    """Return how a motion ``(T,)`` accelerates along the ground but for its steps ``(T, 3)`` [m/s^2].

    As its root faces: forward, left, 0.
    """
    velocity_w = frames.root_lin_vel_w * np.array([1.0, 1.0, 0.0])
    smooth_w = gaussian_filter1d(velocity_w, _SMOOTH_FRAMES, axis=0, mode="nearest")
    return rotations.rotate(_to_heading(frames), np.gradient(smooth_w, 1.0 / RATE_HZ, axis=0))


def lean(frames: CharacterState, parts: Sequence[CharacterState]) -> CharacterState:
    """Return a motion leant into what it accelerates more than the parts that it was made of.

    Args:
        frames: the motion ``(T,)``.
        parts: the captured motions, one after the other, together ``(T,)``.
    """
    captured_h = np.concatenate([acceleration_h(part) for part in parts])
    added_w = rotations.rotate(rotations.conjugate(_to_heading(frames)), acceleration_h(frames) - captured_h)
    size = np.linalg.norm(added_w, axis=-1, keepdims=True)
    towards_w = added_w / np.maximum(size, 1e-9)
    axis_w = np.cross(np.array([0.0, 0.0, 1.0]), towards_w)
    tip = rotations.from_rotation_vector(axis_w * np.arctan2(size, GRAVITY_M_S2))
    up = frames.root_pos_w * np.array([0.0, 0.0, 1.0])
    return with_velocities(
        replace(
            frames,
            root_pos_w=frames.root_pos_w - up + rotations.rotate(tip, up),
            root_quat_w=rotations.multiply(tip, frames.root_quat_w),
        )
    )


def _to_heading(frames: CharacterState) -> np.ndarray:
    return rotations.conjugate(rotations.heading(frames.root_quat_w))
