"""Forward kinematics: where every body is and how fast it moves, for numpy and torch, any batch.

With R_p the world rotation of a body's parent, o its offset there, q_l its rotation against the parent
(the product of its hinges) and w_l its relative angular velocity in the parent's frame:

    R = R_p R_l          x = x_p + R_p o
    w = w_p + R_p w_l    v = v_p + w_p x (R_p o)

The rotations are chained level by level down the tree. The other three are then sums over a body's
ancestors, taken for all bodies at once by one matrix of zeros and ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from unicon import rotations
from unicon.arrays import array_namespace
from unicon.humanoid.table import BODIES, HINGES
from unicon.state import CharacterState

Array = Any

_MAX_HINGES = 3


@dataclass(frozen=True)
class BodyKinematics:
    """All 20 bodies, in the humanoid's body order; the origin of a body is where its hinges are."""

    pos_w: Array
    """Positions of the origins ``(..., 20, 3)`` [m], world frame."""
    rot_w: Array
    """Rotation matrices ``(..., 20, 3, 3)``, body to world."""
    lin_vel_w: Array
    """Velocities of the origins ``(..., 20, 3)`` [m/s], world frame."""
    ang_vel_w: Array
    """Angular velocities ``(..., 20, 3)`` [rad/s], world frame."""
    local_quat: Array
    """Rotations against the parent ``(..., 20, 4)``; the identity for the root."""
    local_ang_vel: Array
    """Angular velocities against the parent ``(..., 20, 3)`` [rad/s], parent's frame; root: zero."""

    @property
    def quat_w(self) -> Array:
        """Rotations ``(..., 20, 4)``, w x y z, body to world."""
        return rotations.from_matrix(self.rot_w)


class _Level(NamedTuple):
    """The bodies at one depth of the tree."""

    bodies: list[int]
    parents: list[int]
    """Position of each body's parent within the level above."""


def _index_of(name: str | None) -> int:
    return next((i for i, body in enumerate(BODIES) if body.name == name), -1)


PARENTS: list[int] = [_index_of(body.parent) for body in BODIES]
"""Index of each body's parent, -1 for the root."""


def _levels() -> list[_Level]:
    above, levels = [0], []
    while below := [i for i, parent in enumerate(PARENTS) if parent in above]:
        levels.append(_Level(below, [above.index(PARENTS[i]) for i in below]))
        above = below
    return levels


def _ancestors() -> np.ndarray:
    """Return ``(20, 20)``: row i has a one for body i and each of its ancestors but the root."""
    matrix = np.zeros((len(BODIES), len(BODIES)))
    for i in range(1, len(BODIES)):
        matrix[i] = matrix[PARENTS[i]]
        matrix[i, i] = 1.0
    return matrix


def _hinge_slots() -> tuple[np.ndarray, np.ndarray]:
    """Return each body's hinges ``(20, 3)``, 35 where it has fewer, and their axes ``(20, 3, 3)``."""
    slots = np.full((len(BODIES), _MAX_HINGES), len(HINGES))
    axes = np.zeros((len(BODIES), _MAX_HINGES, 3))
    axes[..., 0] = 1.0
    first = 0
    for i, body in enumerate(BODIES):
        for k, hinge in enumerate(body.hinges):
            slots[i, k], axes[i, k] = first + k, hinge.axis
        first += len(body.hinges)
    return slots, axes


_LEVELS = _levels()
_ORDER = np.argsort([0, *(i for level in _LEVELS for i in level.bodies)])
_SLOTS, _AXES = _hinge_slots()
_CONSTANTS = {
    "axes": _AXES,
    "ancestors": _ancestors(),
    "offsets": np.array([body.offset if body.parent else (0.0, 0.0, 0.0) for body in BODIES]),
}
_PARENT_OR_ROOT = [max(parent, 0) for parent in PARENTS]


@cache
def _constant(name: str, xp: Any, dtype: Any, device: Any) -> Array:
    return xp.asarray(_CONSTANTS[name], dtype=dtype, device=device)


def forward_kinematics(state: CharacterState) -> BodyKinematics:
    """Return the bodies of the states ``(...)``."""
    xp = array_namespace(state.root_pos_w)
    kind = (xp, state.root_pos_w.dtype, state.root_pos_w.device)
    local_quat, local_ang_vel = _hinge_rotations(state, kind)
    rot_w = _chain(xp, rotations.to_matrix(state.root_quat_w), rotations.to_matrix(local_quat))
    parent_rot_w = rot_w[..., _PARENT_OR_ROOT, :, :]
    arm_w = (parent_rot_w @ _constant("offsets", *kind)[..., None])[..., 0]
    spin_w = (parent_rot_w @ local_ang_vel[..., None])[..., 0]
    ancestors = _constant("ancestors", *kind)
    ang_vel_w = state.root_ang_vel_w[..., None, :] + ancestors @ spin_w
    lever_vel_w = rotations.cross(ang_vel_w[..., _PARENT_OR_ROOT, :], arm_w)
    return BodyKinematics(
        pos_w=state.root_pos_w[..., None, :] + ancestors @ arm_w,
        rot_w=rot_w,
        lin_vel_w=state.root_lin_vel_w[..., None, :] + ancestors @ lever_vel_w,
        ang_vel_w=ang_vel_w,
        local_quat=local_quat,
        local_ang_vel=local_ang_vel,
    )


def _hinge_rotations(state: CharacterState, kind: tuple[Any, Any, Any]) -> tuple[Array, Array]:
    """Return each body's rotation ``(..., 20, 4)`` and spin ``(..., 20, 3)`` against its parent."""
    xp = kind[0]
    axes = _constant("axes", *kind)
    padding = xp.zeros_like(state.joint_pos[..., :1])
    angles = xp.concat([state.joint_pos, padding], axis=-1)[..., _SLOTS]
    rates = xp.concat([state.joint_vel, padding], axis=-1)[..., _SLOTS]
    turns = rotations.from_axis_angle(axes, angles)
    spins = axes * rates[..., None]
    first_two = rotations.multiply(turns[..., 0, :], turns[..., 1, :])
    spin = (
        spins[..., 0, :]
        + rotations.rotate(turns[..., 0, :], spins[..., 1, :])
        + rotations.rotate(first_two, spins[..., 2, :])
    )
    return rotations.multiply(first_two, turns[..., 2, :]), spin


def _chain(xp: Any, root_rot_w: Array, local_rot: Array) -> Array:
    """Multiply the local rotations ``(..., 20, 3, 3)`` down the tree, level by level."""
    levels = [root_rot_w[..., None, :, :]]
    for level in _LEVELS:
        levels.append(levels[-1][..., level.parents, :, :] @ local_rot[..., level.bodies, :, :])
    return xp.concat(levels, axis=-3)[..., _ORDER, :, :]
