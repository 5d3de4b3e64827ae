"""States, clips and target messages that tests make, without any download."""

from __future__ import annotations

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.motion.clip import Clip, clip_from_poses
from unicon.state import CharacterState, stack
from unicon.target_frames import RawFrame, RawTargetFrames

TICK_NS = 1_000_000_000 // 60
START_NS = 1_700_000_000_000_000_000


def standing(x: float = 0.0, y: float = 0.0) -> CharacterState:
    rest = HUMANOID.rest_state()
    return CharacterState(**{**vars(rest), "root_pos_w": rest.root_pos_w + np.array([x, y, 0.0])})


def raw_frame(state: CharacterState) -> RawFrame:
    return RawFrame(*(np.array(value) for value in vars(state).values()))


def message(
    sequence: int,
    time_ns: int,
    *states: CharacterState,
    source: str = "test",
    interval_s: float = 1 / 60,
) -> RawTargetFrames:
    frames = [raw_frame(state) for state in (states or (standing(),))]
    return RawTargetFrames(source, sequence, HUMANOID.id, time_ns, interval_s, frames)


def swaying(count: int, speed: float = 0.1) -> CharacterState:
    """A batch that moves forward slowly and bends its knees and arms."""
    states = []
    for k in range(count):
        joint_pos = np.zeros(35)
        for name, size in (("left_shoulder_x", 0.8), ("right_elbow", -0.6), ("abdomen_z", 0.2)):
            joint_pos[HUMANOID.joint_names.index(name)] = size * np.sin(2 * np.pi * k / 60)
        state = standing(x=speed * k / 60)
        states.append(CharacterState(**{**vars(state), "joint_pos": joint_pos}))
    return stack(states)


def swaying_clip(count: int = 90, speed: float = 0.1, name: str = "sway") -> Clip:
    poses = swaying(count, speed)
    return clip_from_poses(name, poses.root_pos_w, poses.root_quat_w, poses.joint_pos, label="test")
