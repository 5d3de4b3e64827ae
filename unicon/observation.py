"""What the policy sees: o, y and s_t of the paper (section 4.1), all agent-centric.

Everything is expressed in the character's heading frame (suffix ``_h``): the root's place on the ground
and its turn about the vertical axis are taken away, its height and tilt stay. Turning or shifting the
whole world along the ground therefore changes nothing.

    o(X)      one state by itself                                                   197 numbers
    y(X~, X)  how the target's root stands to the avatar's: place and rotation        9 numbers
    s_t     = [o(X~_t), o(X_t+1), y(X~_t, X_t+1), ..., o(X_t+tau), y(X~_t, X_t+tau)]
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from unicon import rotations
from unicon.arrays import array_namespace
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.state import CharacterState

Array = Any

OBSERVATION_LAYOUT: tuple[tuple[str, int], ...] = (
    ("root_height", 1),
    ("root_rot6d_h", 6),
    ("body_pos_h", 19 * 3),
    ("body_lin_vel_h", 20 * 3),
    ("root_ang_vel_h", 3),
    ("joint_pos", 35),
    ("joint_vel", 35),
)
"""The parts of o(X) in their order, with their lengths; ``body_pos_h`` is relative to the root."""

RELATION_LAYOUT: tuple[tuple[str, int], ...] = (("root_offset_h", 3), ("root_turn_rot6d", 6))
"""The parts of y(X~, X) in their order, with their lengths."""

OBSERVATION_SIZE = sum(size for _, size in OBSERVATION_LAYOUT)
RELATION_SIZE = sum(size for _, size in RELATION_LAYOUT)
MAX_TAU = 8

OBSERVATION_ID = hashlib.sha256(json.dumps([OBSERVATION_LAYOUT, RELATION_LAYOUT]).encode()).hexdigest()[:16]
"""Names this layout in policy files; a policy made for another one is refused."""


def policy_input_size(tau: int) -> int:
    """Return the length of s_t for ``tau`` target frames (1 to 8)."""
    return OBSERVATION_SIZE + tau * (OBSERVATION_SIZE + RELATION_SIZE)


def observe(state: CharacterState, kinematics: BodyKinematics) -> Array:
    """Return o(X) ``(..., 197)`` of the states ``(...)``, in the order of ``OBSERVATION_LAYOUT``."""
    xp = array_namespace(state.root_pos_w)
    heading = rotations.heading(state.root_quat_w)
    root_quat_h = rotations.multiply(rotations.conjugate(heading), state.root_quat_w)
    heading_of_bodies = heading[..., None, :]
    offset_w = kinematics.pos_w[..., 1:, :] - state.root_pos_w[..., None, :]
    pos_h = rotations.rotate_inverse(heading_of_bodies, offset_w)
    vel_h = rotations.rotate_inverse(heading_of_bodies, kinematics.lin_vel_w)
    batch = state.batch_shape
    return xp.concat(
        [
            state.root_pos_w[..., 2:3],
            rotations.to_rot6d(root_quat_h),
            xp.reshape(pos_h, (*batch, 57)),
            xp.reshape(vel_h, (*batch, 60)),
            rotations.rotate_inverse(heading, state.root_ang_vel_w),
            state.joint_pos,
            state.joint_vel,
        ],
        axis=-1,
    )


def relate(actual: CharacterState, target: CharacterState) -> Array:
    """Return y(X~, X) ``(..., 9)``: where the target's root is, seen from the avatar's.

    The offset is in the avatar's heading frame [m]; the turn is q~^-1 q as the first two columns of its
    matrix.
    """
    xp = array_namespace(actual.root_pos_w)
    heading = rotations.heading(actual.root_quat_w)
    offset_h = rotations.rotate_inverse(heading, target.root_pos_w - actual.root_pos_w)
    turn = rotations.multiply(rotations.conjugate(actual.root_quat_w), target.root_quat_w)
    return xp.concat([offset_h, rotations.to_rot6d(turn)], axis=-1)


def policy_input(actual: CharacterState, targets: CharacterState) -> Array:
    """Return s_t ``(..., 197 + 206 tau)`` for states ``(...)`` and their targets ``(..., tau)``."""
    xp = array_namespace(actual.root_pos_w)
    actual = actual[..., None, :]
    together = _join_frames(actual, targets)
    seen = observe(together, forward_kinematics(together))
    relation = relate(actual, targets)
    future = xp.concat([seen[..., 1:, :], relation], axis=-1)
    flat = xp.reshape(future, (*targets.batch_shape[:-1], -1))
    return xp.concat([seen[..., 0, :], flat], axis=-1)


def _join_frames(first: CharacterState, rest: CharacterState) -> CharacterState:
    """Join ``(..., 1)`` and ``(..., tau)`` states to ``(..., 1 + tau)`` for one pass of kinematics."""
    xp = array_namespace(first.root_pos_w)
    pairs = zip(vars(first).values(), vars(rest).values(), strict=True)
    return CharacterState(*(xp.concat([a, b], axis=-2) for a, b in pairs))
