"""A walker on flat ground, for tests: feet that swing in turns while the root goes along."""

from __future__ import annotations

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.motion.clip import Clip, clip_from_poses

CYCLE_S = 1.0


def walker(name: str, seconds: float, speed: float = 1.0, heading: float = 0.0, step: float = 0.35) -> Clip:
    """Return a walk of one-second cycles, its hips and knees swinging; with step 0 it stands."""
    times = np.arange(round(seconds * 60) + 1) / 60
    rest = HUMANOID.rest_state()
    joint_pos = np.zeros((len(times), 35))
    for side, offset in (("left", 0.0), ("right", np.pi)):
        angle = 2 * np.pi * times / CYCLE_S + offset
        joint_pos[:, HUMANOID.joint_names.index(f"{side}_hip_y")] = -step * np.sin(angle)
        joint_pos[:, HUMANOID.joint_names.index(f"{side}_knee")] = 2 * step * np.maximum(np.cos(angle), 0)
    along = np.array([np.cos(heading), np.sin(heading), 0.0])
    pos_w = rest.root_pos_w + speed * times[:, None] * along
    quat_w = np.tile(rotations.from_heading(np.array(heading)), (len(times), 1))
    return clip_from_poses(name, pos_w, quat_w, joint_pos, source="made", licence="CC0-1.0")
