"""Changes how a walk steps: feet that do not swivel in a turn, shorter strides, a body that faces aside.

All act on the hinges of the legs alone and leave small errors, which planting the feet takes away.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon import rotations
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip import continuous_signs
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import ContactConfig, Soles, find_contacts
from unicon.motion.grounding.leg_ik import SIDES, leg_of
from unicon.motion.grounding.smooth_change import SmoothChange
from unicon.state import CharacterState, differentiate

_SMOOTHNESS = 5.0
"""Weight of the second differences of a leg's turn against its errors in stance."""
_PULL = 1e-3
"""Weight of the leg's own turn, against that of a foot that swivels."""
_STRIDE_FRAMES = 20.0
_APART_RAD = 0.06
"""By how much each leg of one who steps on the spot is spread."""
_LIFT = 0.5
"""How little the legs move at least, of what they did: who steps on the spot lifts the feet as well."""


def hold_foot_yaw(frames: CharacterState, turn: np.ndarray) -> np.ndarray:
    """Return hinge angles ``(T, 35)`` with which standing feet do not turn with a body that is turned.

    While a foot stands, its leg turns by c at the hip, with c + turn constant; between two stances it comes
    round smoothly. Of all such turns the smallest smooth one is taken.

    Args:
        frames: the motion ``(T,)`` before it is turned.
        turn: by how much its heading is going to be turned ``(T,)`` [rad].
    """
    soles = Soles(forward_kinematics(frames))
    contact = find_contacts(soles, frames.root_pos_w, ContactConfig())
    joint_pos = frames.joint_pos.copy()
    for foot, side in enumerate(SIDES):
        stands = contact[1:, foot] & contact[:-1, foot]
        change = SmoothChange(len(turn))
        change.want_steps(np.where(stands, 1.0, 0.0), -np.diff(turn))
        change.want_values(_PULL, 0.0)
        change.want_bends(_SMOOTHNESS, 0.0)
        joint_pos[:, leg_of(side).hip[1]] += change.solve()[:, 0]
    return joint_pos


def shorten(frames: CharacterState, share: float) -> CharacterState:
    """Return a steady walk ``(T,)`` with strides of a share of its own, at the same pace of steps.

    The path without its sway and the swing of all hinges about their mean are scaled, feet are set apart.
    """
    path = gaussian_filter1d(frames.root_pos_w[:, :2], _STRIDE_FRAMES, axis=0, mode="nearest")
    pos_w = frames.root_pos_w.copy()
    pos_w[:, :2] += (share - 1.0) * (path - path[:1])
    lift = max(share, _LIFT)
    mean = frames.joint_pos.mean(axis=0)
    joint_pos = mean + lift * (frames.joint_pos - mean)
    for side, outward in zip(SIDES, (1.0, -1.0), strict=True):
        leg = leg_of(side)
        knee = joint_pos[:, leg.knee] - mean[leg.knee]
        for hinge in (leg.hip[2], leg.ankle[0]):
            swing = mean[hinge] + share * (frames.joint_pos[:, hinge] - mean[hinge])
            joint_pos[:, hinge] = swing - 0.5 * (1.0 - share / lift) * knee
        joint_pos[:, leg.hip[0]] += outward * _APART_RAD * (1.0 - share)
        joint_pos[:, leg.ankle[1]] -= outward * _APART_RAD * (1.0 - share)
    return differentiate(pos_w, continuous_signs(frames.root_quat_w), joint_pos, RATE_HZ)


def face_aside(frames: CharacterState, angle: float) -> CharacterState:
    """Return a walk ``(T,)`` whose body faces an angle [rad] to the left of where its legs go on walking."""
    joint_pos = frames.joint_pos.copy()
    for side in SIDES:
        joint_pos[:, leg_of(side).hip[1]] -= angle
    aside = rotations.from_heading(np.full(frames.batch_shape, angle))
    quat = continuous_signs(rotations.multiply(aside, frames.root_quat_w))
    return differentiate(frames.root_pos_w, quat, joint_pos, RATE_HZ)
