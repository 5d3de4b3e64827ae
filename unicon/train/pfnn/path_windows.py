"""The path around every frame of a take, as the network gets it, and the path ahead that it answers.

What lies behind is where the root was and faced. What lies ahead is the take's path without the sway of
single steps, as a person steers it: position and heading smoothed over about a stride. Beyond the ends of a
take, which stands there, the path stays where it is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon import rotations
from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.pfnn.layout import AHEAD, PRESENT, SAMPLE_FRAMES, SAMPLES, PathSamples
from unicon.state import CharacterState
from unicon.train.pfnn.gaits import label_gaits

SWAY_FRAMES = 14.0


class TakePath(NamedTuple):
    """The path of a take along the ground, T frames."""

    pos_w: np.ndarray
    """Of the root ``(T, 2)`` [m]."""
    heading: np.ndarray
    """Of the root, without jumps ``(T,)`` [rad]."""
    smooth_pos_w: np.ndarray
    """Without sway ``(T, 2)``."""
    smooth_heading: np.ndarray
    """Without sway ``(T,)``."""
    gaits: np.ndarray
    """Weights ``(T, 5)``."""


def path_of(frames: CharacterState) -> TakePath:
    """Return the path of a take ``(T,)`` that stands at both ends."""
    pos_w = frames.root_pos_w[:, :2]
    heading = np.unwrap(rotations.heading_angle(frames.root_quat_w))
    smooth = gaussian_filter1d(pos_w, SWAY_FRAMES, axis=0, mode="nearest")
    smooth_heading = gaussian_filter1d(heading, SWAY_FRAMES, mode="nearest")
    speed = np.linalg.norm(np.gradient(smooth, axis=0), axis=-1) * RATE_HZ
    turn_rate = np.gradient(smooth_heading) * RATE_HZ
    return TakePath(pos_w, heading, smooth, smooth_heading, label_gaits(speed, turn_rate))


def windows_around(path: TakePath, frames: np.ndarray) -> PathSamples:
    """Return the samples around frames ``(N,)``, in the root's heading frame at each."""
    at = frames[:, None] + (np.arange(SAMPLES) - PRESENT) * SAMPLE_FRAMES
    ahead = at > frames[:, None]
    at = np.clip(at, 0, len(path.heading) - 1)
    pos_w = np.where(ahead[..., None], path.smooth_pos_w[at], path.pos_w[at])
    heading = np.where(ahead, path.smooth_heading[at], path.heading[at])
    return PathSamples(*_in_heading_frame(path, frames, pos_w, heading), path.gaits[at])


def windows_ahead(path: TakePath, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and facings ``(N, 6, 2)`` from frames ``(N,)`` on, in the heading frame at each."""
    samples = windows_around(path, frames)
    return samples.pos_h[:, -AHEAD:], samples.facing_h[:, -AHEAD:]


def _in_heading_frame(
    path: TakePath, frames: np.ndarray, pos_w: np.ndarray, heading: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    offset = pos_w - path.pos_w[frames][:, None]
    here = path.heading[frames][:, None]
    cos, sin = np.cos(here), np.sin(here)
    pos_h = np.stack(
        [cos * offset[..., 0] + sin * offset[..., 1], cos * offset[..., 1] - sin * offset[..., 0]], axis=-1
    )
    turn = heading - here
    return pos_h, np.stack([np.cos(turn), np.sin(turn)], axis=-1)
