"""Motions whose contacts are known exactly: a walk, a jump, a pose held still."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.leg_ik import SIDES, leg_of, move_foot
from unicon.state import CharacterState, differentiate

PERIOD, STANCE = 60, 36
"""Frames of a stride, and of those a foot stands for."""
HIPS_LOWERED_M = 0.1


class Walk(NamedTuple):
    frames: CharacterState
    contact: np.ndarray
    """When each foot stands ``(T, 2)``, exactly."""


def pose(count: int = 1, lowered_m: float = 0.0, **angles: float) -> CharacterState:
    """Stand with bent knees, soles on the floor, the hips lowered; then set some hinges [rad]."""
    root_pos = np.tile([0.0, 0.0, 0.95 - lowered_m], (count, 1))
    quat = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    joint_pos = np.zeros((count, 35))
    up = np.tile([0.0, 0.0, lowered_m], (count, 2, 1))
    joint_pos = place_feet(_state(root_pos, quat, joint_pos), up).joint_pos.copy()
    for name, angle in angles.items():
        joint_pos[:, HUMANOID.joint_names.index(name)] = angle
    return _state(root_pos, quat, joint_pos)


def walk(count: int = 180, speed: float = 1.0) -> Walk:
    """Walk forward; standing feet are flat and don't move at all."""
    phase = (np.arange(count)[:, None] + np.array([0, PERIOD // 2])) % PERIOD
    stride = speed * PERIOD / RATE_HZ
    swing = np.clip((phase - STANCE) / (PERIOD - STANCE), 0.0, 1.0)
    eased = swing**3 * (10.0 - 15.0 * swing + 6.0 * swing**2)
    against_root = stride * (0.5 * STANCE - phase) / PERIOD + stride * eased
    base = pose(count, HIPS_LOWERED_M)
    root_pos = base.root_pos_w + np.outer(np.arange(count) * speed / RATE_HZ, [1.0, 0.0, 0.0])
    height = 0.08 * np.sin(np.pi * swing) ** 2
    offset = np.stack([against_root, np.zeros_like(height), height], axis=-1)
    joint_pos = place_feet(base, offset).joint_pos
    return Walk(differentiate(root_pos, base.root_quat_w, joint_pos, RATE_HZ), phase < STANCE)


def jump(gravity: float = 9.81, rise_m: float = 0.3, before: int = 60) -> tuple[CharacterState, np.ndarray]:
    """Crouch, jump straight up as a parabola, land and come to rest; and the frames in the air."""
    airtime_s = np.sqrt(8 * rise_m / gravity)
    speed = 0.5 * gravity * airtime_s
    times = np.arange(2 * before + int(airtime_s * RATE_HZ)) / RATE_HZ - before / RATE_HZ
    depth = 0.3
    slow_s = 2 * depth / speed
    down = np.where(times < 0.0, _brake(-times, slow_s, speed), _brake(times - airtime_s, slow_s, speed))
    height = speed * times - 0.5 * gravity * times**2
    air = (times > 0.0) & (times < airtime_s)
    lowered = 0.02 + np.where(air, 0.0, down)
    base = pose(len(times))
    up = np.outer(lowered, [0.0, 0.0, 1.0])
    joint_pos = place_feet(base, np.stack([up, up], axis=1)).joint_pos
    root_pos = base.root_pos_w + np.outer(np.where(air, height, 0.0) - lowered, [0.0, 0.0, 1.0])
    return differentiate(root_pos, base.root_quat_w, joint_pos, RATE_HZ), air


def _brake(times: np.ndarray, slow_s: float, speed: float) -> np.ndarray:
    """Return how deep a body is that hits a spring at a speed: down, and slowly up again."""
    t = np.maximum(times, 0.0)
    return speed * t * np.exp(-t * 2.0 / slow_s)


def place_feet(frames: CharacterState, offset: np.ndarray) -> CharacterState:
    """Shift the ankles by exactly ``(T, 2, 3)`` [m]: the leg's limited stretch makes one go fall short."""
    goal = ankles(frames) + offset
    for _ in range(6):
        for foot, side in enumerate(SIDES):
            left = goal[:, foot] - ankles(frames)[:, foot]
            angles = move_foot(frames.joint_pos, forward_kinematics(frames), side, left)
            frames = replace(frames, joint_pos=angles)
    return frames


def ankles(frames: CharacterState) -> np.ndarray:
    """Return where the ankles are ``(T, 2, 3)`` [m]."""
    return forward_kinematics(frames).pos_w[:, [leg_of(side).foot for side in SIDES]]


def with_poses(frames: CharacterState, **fields: np.ndarray) -> CharacterState:
    """Replace root or hinges, with velocities anew."""
    values = {name: getattr(frames, name) for name in ("root_pos_w", "root_quat_w", "joint_pos")} | fields
    return differentiate(values["root_pos_w"], values["root_quat_w"], values["joint_pos"], RATE_HZ)


def _state(root_pos: np.ndarray, quat: np.ndarray, joint_pos: np.ndarray) -> CharacterState:
    zeros = np.zeros_like(root_pos)
    return CharacterState(root_pos, quat, zeros, zeros, joint_pos, np.zeros_like(joint_pos))
