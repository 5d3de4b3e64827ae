"""CharacterState: where every part of the character is and how fast it moves (X of the paper, section 4.1).

The canonical pose is the root's position and rotation and the 35 hinge angles; everything else follows
by forward kinematics. Linear and angular velocities are those of the root body's origin in the WORLD
frame. MuJoCo stores the free joint's angular velocity in the root's own frame; only this module knows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from unicon import rotations
from unicon.arrays import array_namespace

Array = Any


@dataclass(frozen=True)
class CharacterState:
    """One state, or a batch of them with the same leading dimensions."""

    root_pos_w: Array
    """Position of the root body's origin ``(..., 3)`` [m], world frame."""
    root_quat_w: Array
    """Rotation of the root body ``(..., 4)``, unit, w x y z, root to world."""
    root_lin_vel_w: Array
    """Linear velocity of the root body's origin ``(..., 3)`` [m/s], world frame."""
    root_ang_vel_w: Array
    """Angular velocity of the root body ``(..., 3)`` [rad/s], world frame."""
    joint_pos: Array
    """Hinge angles ``(..., 35)`` [rad], in the humanoid's joint order."""
    joint_vel: Array
    """Hinge velocities ``(..., 35)`` [rad/s]."""

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """The leading dimensions shared by all fields."""
        return tuple(self.root_pos_w.shape[:-1])

    def __getitem__(self, index: Any) -> CharacterState:
        """Select along the leading dimensions."""
        return CharacterState(*(getattr(self, f.name)[index] for f in fields(self)))

    def to_mujoco(self) -> tuple[Array, Array]:
        """Return ``qpos (..., 42)`` and ``qvel (..., 41)`` of MuJoCo's free joint and hinges."""
        xp = array_namespace(self.root_pos_w)
        ang_vel_b = rotations.rotate_inverse(self.root_quat_w, self.root_ang_vel_w)
        qpos = xp.concat([self.root_pos_w, self.root_quat_w, self.joint_pos], axis=-1)
        qvel = xp.concat([self.root_lin_vel_w, ang_vel_b, self.joint_vel], axis=-1)
        return qpos, qvel

    @classmethod
    def from_mujoco(cls, qpos: Array, qvel: Array) -> CharacterState:
        """Read a state from ``qpos (..., 42)`` and ``qvel (..., 41)``; the arrays may be views."""
        quat = qpos[..., 3:7]
        return cls(
            root_pos_w=qpos[..., :3],
            root_quat_w=quat,
            root_lin_vel_w=qvel[..., :3],
            root_ang_vel_w=rotations.rotate(quat, qvel[..., 3:6]),
            joint_pos=qpos[..., 7:42],
            joint_vel=qvel[..., 6:41],
        )


def _combine(states: Sequence[CharacterState], join: str) -> CharacterState:
    xp = array_namespace(states[0].root_pos_w)
    function = getattr(xp, join)
    names = [f.name for f in fields(CharacterState)]
    return CharacterState(*(function([getattr(s, n) for s in states], axis=0) for n in names))


def stack(states: Sequence[CharacterState]) -> CharacterState:
    """Stack states along a new first dimension."""
    return _combine(states, "stack")


def concatenate(states: Sequence[CharacterState]) -> CharacterState:
    """Join batches of states along their first dimension."""
    return _combine(states, "concat")


def interpolate(a: CharacterState, b: CharacterState, t: Array) -> CharacterState:
    """Blend from ``a`` (t = 0) to ``b`` (t = 1): spherically for the root, linearly for the rest.

    ``t (...)`` has the batch shape (a scalar array for single states).
    """
    xp = array_namespace(a.root_pos_w)
    t = xp.asarray(t, dtype=a.root_pos_w.dtype)
    weight = t[..., None]

    def mix(first: Array, second: Array) -> Array:
        return first + weight * (second - first)

    return CharacterState(
        root_pos_w=mix(a.root_pos_w, b.root_pos_w),
        root_quat_w=rotations.slerp(a.root_quat_w, b.root_quat_w, t),
        root_lin_vel_w=mix(a.root_lin_vel_w, b.root_lin_vel_w),
        root_ang_vel_w=mix(a.root_ang_vel_w, b.root_ang_vel_w),
        joint_pos=mix(a.joint_pos, b.joint_pos),
        joint_vel=mix(a.joint_vel, b.joint_vel),
    )


def extrapolate(s: CharacterState, dt_s: Array) -> CharacterState:
    """Move on with constant velocities for ``dt_s (...)`` [s]."""
    xp = array_namespace(s.root_pos_w)
    dt = xp.asarray(dt_s, dtype=s.root_pos_w.dtype)[..., None]
    turn = rotations.from_rotation_vector(dt * s.root_ang_vel_w)
    return CharacterState(
        root_pos_w=s.root_pos_w + dt * s.root_lin_vel_w,
        root_quat_w=rotations.multiply(turn, s.root_quat_w),
        root_lin_vel_w=s.root_lin_vel_w,
        root_ang_vel_w=s.root_ang_vel_w,
        joint_pos=s.joint_pos + dt * s.joint_vel,
        joint_vel=s.joint_vel,
    )


def hold(s: CharacterState) -> CharacterState:
    """Return the same pose at rest: all velocities zero."""
    xp = array_namespace(s.root_pos_w)
    return CharacterState(
        root_pos_w=s.root_pos_w,
        root_quat_w=s.root_quat_w,
        root_lin_vel_w=xp.zeros_like(s.root_lin_vel_w),
        root_ang_vel_w=xp.zeros_like(s.root_ang_vel_w),
        joint_pos=s.joint_pos,
        joint_vel=xp.zeros_like(s.joint_vel),
    )


def move(s: CharacterState, heading_rad: Array, offset_w: Array) -> CharacterState:
    """Turn the whole state by ``heading_rad (...)`` about the world's z axis, then shift it.

    ``offset_w (..., 3)`` [m]. The pose relative to the character's own heading stays the same.
    """
    xp = array_namespace(s.root_pos_w)
    heading_rad = xp.asarray(heading_rad, dtype=s.root_pos_w.dtype)
    offset_w = xp.asarray(offset_w, dtype=s.root_pos_w.dtype)
    turn = rotations.from_heading(heading_rad)
    return CharacterState(
        root_pos_w=rotations.rotate(turn, s.root_pos_w) + offset_w,
        root_quat_w=rotations.multiply(turn, s.root_quat_w),
        root_lin_vel_w=rotations.rotate(turn, s.root_lin_vel_w),
        root_ang_vel_w=rotations.rotate(turn, s.root_ang_vel_w),
        joint_pos=s.joint_pos,
        joint_vel=s.joint_vel,
    )


def differentiate(
    root_pos_w: np.ndarray, root_quat_w: np.ndarray, joint_pos: np.ndarray, rate_hz: float
) -> CharacterState:
    """Add velocities to a path of poses ``(T, 3)``, ``(T, 4)``, ``(T, 35)`` sampled at ``rate_hz``.

    Central differences, and second-order one-sided ones at both ends, so that the first and last
    frames are as fast as the rest. The angular velocity is exact for a steady turn:
    log(q[t+1] q[t-1]^-1) / 2dt. Quaternions may change sign from frame to frame.

    Raises:
        ValueError: with fewer than two frames.
    """
    if len(root_pos_w) < 2:
        raise ValueError(f"velocities need at least 2 frames, got {len(root_pos_w)}")
    edge = 2 if len(root_pos_w) > 2 else 1
    steps = rotations.multiply(root_quat_w[1:], rotations.conjugate(root_quat_w[:-1]))
    step_w = rotations.to_rotation_vector(steps) * rate_hz
    return CharacterState(
        root_pos_w=root_pos_w,
        root_quat_w=root_quat_w,
        root_lin_vel_w=np.gradient(root_pos_w, 1.0 / rate_hz, axis=0, edge_order=edge),
        root_ang_vel_w=_average_at_frames(step_w),
        joint_pos=joint_pos,
        joint_vel=np.gradient(joint_pos, 1.0 / rate_hz, axis=0, edge_order=edge),
    )


def _average_at_frames(rates: np.ndarray) -> np.ndarray:
    """Turn rates ``(T-1, 3)`` between frames into rates ``(T, 3)`` at frames, linear at the ends."""
    if len(rates) == 1:
        return np.repeat(rates, 2, axis=0)
    middle = 0.5 * (rates[1:] + rates[:-1])
    first = 1.5 * rates[:1] - 0.5 * rates[1:2]
    last = 1.5 * rates[-1:] - 0.5 * rates[-2:-1]
    return np.concatenate([first, middle, last])
