"""What the network is given and what it answers (Holden, Komura, Saito 2017, section 4), for our humanoid.

Everything is expressed in the character's heading frame (suffix ``_h``): origin on the ground below the
root, x where the root faces, z up. One frame is 1/60 s. The path is sampled every 10 frames, from one second
before the present to 5/6 s after it: sample ``PRESENT`` is the present frame.

    x = [path around frame t, o(X_t)]                           input, ``INPUT_SIZE`` numbers
    y = [how the root moves from t to t + 1, phase change, contacts of the feet at t + 1,
         the path ahead of frame t + 1 in ITS heading frame, pose and hinge velocities of t + 1]

o(X) is what the policy sees of one state (``unicon.observation``). The phase goes from 0 to 2 pi in a whole
cycle of two steps: it is 0 when the left foot touches down and pi when the right foot does.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from unicon.observation import OBSERVATION_SIZE

GAITS: tuple[str, ...] = ("stand", "walk", "jog", "run", "crouch")
"""Their weights along the path sum to 1."""
SAMPLE_FRAMES = 10
SAMPLES = 12
PRESENT = 6
"""Which of the samples is the present frame."""
AHEAD = SAMPLES - PRESENT
"""Samples from the present on."""
CONTACTS: tuple[str, ...] = ("left_foot", "left_toe", "right_foot", "right_toe")

INPUT_LAYOUT: tuple[tuple[str, tuple[int, ...]], ...] = (
    ("path_pos_h", (SAMPLES, 2)),  # [m]
    ("path_facing_h", (SAMPLES, 2)),  # unit vectors
    ("path_gait", (SAMPLES, len(GAITS))),  # weights
    ("pose", (OBSERVATION_SIZE,)),  # o(X_t)
)
OUTPUT_LAYOUT: tuple[tuple[str, tuple[int, ...]], ...] = (
    ("root_vel_h", (2,)),  # of the root along the ground, in the heading frame of t [m/s]
    ("turn_rate", (1,)),  # of the heading [rad/s]
    ("phase_rate", (1,)),  # never negative [rad/s]
    ("contacts", (len(CONTACTS),)),  # 1 where that part of the sole is on the ground, else 0
    ("path_pos_h", (AHEAD, 2)),  # [m]
    ("path_facing_h", (AHEAD, 2)),
    ("root_height", (1,)),  # [m]
    ("root_rot6d_h", (6,)),  # of the root against its heading
    ("joint_pos", (35,)),  # [rad]
    ("joint_vel", (35,)),  # [rad/s]
)

INPUT_SIZE = sum(int(np.prod(shape)) for _, shape in INPUT_LAYOUT)
OUTPUT_SIZE = sum(int(np.prod(shape)) for _, shape in OUTPUT_LAYOUT)
LAYOUT_ID = hashlib.sha256(json.dumps([GAITS, INPUT_LAYOUT, OUTPUT_LAYOUT]).encode()).hexdigest()[:16]
"""Names this layout in network files; a network made for another one is refused."""


class PathSamples(NamedTuple):
    """The path around the present, in the heading frame of the present."""

    pos_h: np.ndarray
    """``(..., 12, 2)`` [m]."""
    facing_h: np.ndarray
    """Unit vectors ``(..., 12, 2)``: where the character faces, which may differ from where it goes."""
    gait: np.ndarray
    """Weights ``(..., 12, 5)`` of ``GAITS``."""


def pack_input(path: PathSamples, pose: np.ndarray) -> np.ndarray:
    """Return x ``(..., INPUT_SIZE)`` of the path and o(X) ``(..., 197)``."""
    parts = (path.pos_h, path.facing_h, path.gait, pose[..., None])
    batch = pose.shape[:-1]
    return np.concatenate([np.reshape(part, (*batch, -1)) for part in parts], axis=-1)


def pack_output(parts: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return y ``(..., OUTPUT_SIZE)`` of all parts of ``OUTPUT_LAYOUT``, by name."""
    flat = []
    for name, shape in OUTPUT_LAYOUT:
        part = parts[name]
        batch = part.shape[: part.ndim - len(shape)]
        flat.append(np.reshape(part, (*batch, -1)))
    return np.concatenate(flat, axis=-1)


def unpack_output(y: np.ndarray) -> dict[str, np.ndarray]:
    """Return the parts of y ``(..., OUTPUT_SIZE)`` by name, each of its own shape."""
    return _unpack(y, OUTPUT_LAYOUT)


def unpack_input(x: np.ndarray) -> dict[str, np.ndarray]:
    """Return the parts of x ``(..., INPUT_SIZE)`` by name, each of its own shape."""
    return _unpack(x, INPUT_LAYOUT)


def _unpack(flat: np.ndarray, layout: tuple[tuple[str, tuple[int, ...]], ...]) -> dict[str, np.ndarray]:
    parts, start = {}, 0
    for name, shape in layout:
        size = int(np.prod(shape))
        parts[name] = flat[..., start : start + size].reshape(*flat.shape[:-1], *shape)
        start += size
    return parts
