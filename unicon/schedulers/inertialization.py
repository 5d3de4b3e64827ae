"""Inertialisation: a motion begins at once, and what it differs by from what was before fades away.

At the seam (t = 0) the path has the state E, and the motion, one frame before its first, the state S. The
motion is turned to the heading of E. Then, with s(u) = u^2 (3 - 2u), u = t / T and T the transition's length,
each hinge, the height and the rotation (as a rotation vector) get

    x(t) = x0 (1 - s(u)) + v0 t exp(-8 u),          x0 = E - S,  v0 = E' - S'

so that pose and velocity go on without a jump, and a fast limb does not carry on for long. Along the ground
only the velocity fades: the root changes its speed evenly, and the motion is set ahead by what that takes,

    r(t) = v0 (T (u - u^3 + u^4 / 2) - T / 2),      r(T) = 0.

D. Bollo, "Inertialization", GDC 2018, with another decay. In contrast to a blend between two still poses, the
legs step as the root sets off.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon import rotations, state
from unicon.motion.clip_index import RATE_HZ
from unicon.state import CharacterState

_FADE = 8.0


def begin_after(frames: CharacterState, end: CharacterState, transition_s: float) -> CharacterState:
    """Return the poses of a motion that goes on from a state; their velocities are not made anew.

    Args:
        frames: the motion ``(T,)`` at 60 Hz.
        end: the state one frame before its first.
        transition_s: time in which the difference fades [s]; 0: at once, only place and heading are kept.
    """
    count = frames.batch_shape[0]
    turn = rotations.heading_angle(end.root_quat_w) - rotations.heading_angle(frames.root_quat_w[0])
    turned = state.move(frames, np.full(count, turn), np.zeros(3))
    start = state.extrapolate(turned[0], np.array(-1.0 / RATE_HZ))
    times = np.arange(1, count + 1) / RATE_HZ
    share = np.minimum(times / transition_s, 1.0) if transition_s > 0.0 else np.ones(count)

    def fade(position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        left = 1.0 - share * share * (3.0 - 2.0 * share)
        carried = np.where(share < 1.0, times * np.exp(-_FADE * share), 0.0)
        return position * left[:, None] + velocity * carried[:, None]

    tilt = rotations.multiply(end.root_quat_w, rotations.conjugate(start.root_quat_w))
    turns = fade(rotations.to_rotation_vector(tilt), end.root_ang_vel_w - start.root_ang_vel_w)
    lift = fade(end.root_pos_w[2:] - start.root_pos_w[2:], end.root_lin_vel_w[2:] - start.root_lin_vel_w[2:])
    slower = (end.root_lin_vel_w - start.root_lin_vel_w)[:2]
    lag = transition_s * (share - share**3 + 0.5 * share**4 - 0.5)
    along = slower * lag[:, None] + (end.root_pos_w - start.root_pos_w)[:2] + 0.5 * transition_s * slower
    return replace(
        turned,
        root_pos_w=turned.root_pos_w + np.concatenate([along, lift], axis=-1),
        root_quat_w=rotations.multiply(rotations.from_rotation_vector(turns), turned.root_quat_w),
        joint_pos=turned.joint_pos + fade(end.joint_pos - start.joint_pos, end.joint_vel - start.joint_vel),
    )
