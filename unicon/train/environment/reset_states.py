"""The state in which an episode begins: reactive state initialisation (Wang et al. 2020, section 4.4).

In some of the starts the avatar is not in the state of the target's frame but in that of one 5 to 10 frames
before or after, so that it learns to come back to a target that it has lost. Every start is disturbed by
noise that is uniform within bounds.
"""

from __future__ import annotations

import numpy as np

from unicon.target_frames import unpack
from unicon.train.environment.environment_config import EnvironmentConfig


def choose_frames(
    frames: np.ndarray, last_frames: np.ndarray, config: EnvironmentConfig, rng: np.random.Generator
) -> np.ndarray:
    """Return the frames ``(n,)`` whose states episodes begin in that begin at ``frames (n,)``.

    Where the clip (``last_frames (n,)``) ends on one side, the frame lies on the other; in a clip that is
    too short on both sides it is nearer.
    """
    low, high = config.rsis_frames
    uniform = rng.random((3, len(frames)))
    distance = low + np.floor(uniform[0] * (high - low + 1)).astype(np.int64)
    after = uniform[1] < 0.5
    after = np.where(frames - distance < 0, True, np.where(frames + distance > last_frames, False, after))
    moved = np.clip(frames + np.where(after, distance, -distance), 0, last_frames)
    return np.where(uniform[2] < config.rsis_share, moved, frames)


def add_noise(rows: np.ndarray, config: EnvironmentConfig, rng: np.random.Generator) -> np.ndarray:
    """Return packed states ``(n, 83)`` with the noises of the configuration; rotations stay as they are."""
    position_m, height_m, joint_rad, velocity = (np.float32(noise) for noise in config.noises)
    noise = rng.random(rows.shape, dtype=np.float32)
    noise *= 2.0
    noise -= 1.0  # within -1..1
    made = rows.copy()
    states, noises = unpack(made), unpack(noise)
    states.root_pos_w[:, :2] += position_m * noises.root_pos_w[:, :2]
    states.root_pos_w[:, 2] += height_m * np.abs(noises.root_pos_w[:, 2])
    states.joint_pos[:] += joint_rad * noises.joint_pos
    for name in ("root_lin_vel_w", "root_ang_vel_w", "joint_vel"):
        value = getattr(states, name)
        value += velocity * np.minimum(1.0, 0.3 + np.abs(value)) * getattr(noises, name)
    return made
