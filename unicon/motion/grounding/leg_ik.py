"""Moves feet by closed form: the leg swings and its knee bends, the sole keeps its tilt.

With H the hip, A the ankle and A' where it has to go, the whole leg first turns by the shortest turn
from A - H to A' - H. The knee's angle k then gives the leg its new length r:

    r^2 = L1^2 + L2^2 + 2 L1 L2 cos k                                (law of cosines)

and the thigh gives back the angle by which that turns the line from hip to ankle. At last the ankle turns
the foot back to its old rotation; it has two hinges, so that a turn of the foot about its own z axis
remains, which for small changes is small. For A' = A all angles stay as they are.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics
from unicon.motion.retargeting.euler import wrap

SIDES = ("left", "right")

THIGH_M, SHIN_M = (
    float(-HUMANOID.offsets[HUMANOID.body_names.index(name), 2]) for name in ("left_shin", "left_foot")
)
STRAIGHT_RAD = np.radians(4.0)
"""A leg is stretched no further than to this angle of the knee."""
LONGEST_M = float(np.sqrt(THIGH_M**2 + SHIN_M**2 + 2 * THIGH_M * SHIN_M * np.cos(STRAIGHT_RAD)))
"""From hip to ankle."""
USED_REACH = 0.8
"""Share of a leg's last bit of length that is used before the hips sink instead."""
SHORTEST_M = 0.12


class Leg(NamedTuple):
    """Indices of one leg."""

    thigh: int
    shin: int
    foot: int
    hip: list[int]
    """Its three hinges, about x, z, y."""
    knee: int
    ankle: list[int]
    """Its two hinges, about y, x."""


@cache
def leg_of(side: str) -> Leg:
    """Return the indices of the left or the right leg."""
    thigh, shin, foot = (HUMANOID.body_names.index(f"{side}_{part}") for part in ("thigh", "shin", "foot"))
    hip, knee, ankle = (
        [HUMANOID.joint_names.index(f"{side}_{hinge}") for hinge in hinges]
        for hinges in (("hip_x", "hip_z", "hip_y"), ("knee",), ("ankle_y", "ankle_x"))
    )
    return Leg(thigh, shin, foot, hip, knee[0], ankle)


def move_foot(joint_pos: np.ndarray, bodies: BodyKinematics, side: str, offset_w: np.ndarray) -> np.ndarray:
    """Return hinge angles ``(T, 35)`` with one foot shifted, the hip staying where it is.

    Args:
        joint_pos: hinge angles ``(T, 35)`` [rad].
        bodies: where these angles put the bodies.
        side: left or right.
        offset_w: how far the ankle goes ``(T, 3)`` [m]; less where the leg is too short.
    """
    leg = leg_of(side)
    old_w = bodies.pos_w[:, leg.foot] - bodies.pos_w[:, leg.thigh]
    offset_w = _regular(joint_pos[:, leg.hip[1]])[:, None] * offset_w
    new_w = old_w + offset_w
    knee = _knee_angle(_within_reach(np.linalg.norm(new_w, axis=-1), np.linalg.norm(old_w, axis=-1)))
    straighten = _lean(joint_pos[:, leg.knee]) - _lean(knee)
    y_axis = np.array([0.0, 1.0, 0.0])
    quat_w = rotations.from_matrix(bodies.rot_w[:, [0, leg.thigh, leg.foot]])
    pelvis, thigh, foot = quat_w[:, 0], quat_w[:, 1], quat_w[:, 2]
    thigh = rotations.multiply(_shortest_turn(old_w, new_w), thigh)
    thigh = rotations.multiply(thigh, rotations.from_axis_angle(y_axis, straighten))
    shin = rotations.multiply(thigh, rotations.from_axis_angle(y_axis, knee))
    result = joint_pos.copy()
    result[:, leg.hip] = _hip_angles(_relative(pelvis, thigh), joint_pos[:, leg.hip])
    result[:, leg.knee] = knee
    result[:, leg.ankle] = _ankle_angles(_relative(shin, foot))
    limited = [*leg.hip, *leg.ankle]
    result[:, limited] = np.clip(
        result[:, limited], HUMANOID.joint_lower[limited], HUMANOID.joint_upper[limited]
    )
    unmoved = ~np.any(offset_w, axis=-1)
    result[unmoved] = joint_pos[unmoved]
    return result


def _regular(hip_z: np.ndarray) -> np.ndarray:
    """Return 1 ``(T,)``, but 0 where a hip's x and y hinges are nearly parallel and can't turn smoothly."""
    return np.clip((np.cos(hip_z) - 0.2) / 0.2, 0.0, 1.0)


def missing_reach(hip_w: np.ndarray, ankle_w: np.ndarray, shift_w: np.ndarray) -> np.ndarray:
    """Return by how much hips ``(T, 3)`` have to sink for ankles ``(T, 3)`` to be shifted ``(T,)`` [m].

    They sink to where a leg takes up at most the share `USED_REACH` of the length that it had left.
    """
    length = np.linalg.norm(ankle_w - hip_w, axis=-1)
    longest = length + USED_REACH * np.maximum(LONGEST_M - length, 0.0)
    wanted = ankle_w + shift_w - hip_w
    highest = np.sqrt(np.maximum(longest**2 - np.sum(wanted[:, :2] ** 2, axis=-1), 0.0))
    return np.maximum(-wanted[:, 2] - highest, 0.0)


def _within_reach(wanted: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Return the length from hip to ankle ``(T,)`` [m]: as wanted, but it only nears the longest.

    Of what is left of the leg, h, a longer leg takes h x / (1 + x^4)^(1/4), where it wants h x: the knee
    slows down before it is straight, and doesn't snap.
    """
    left = np.maximum(LONGEST_M - before, 1e-4)
    share = np.maximum(wanted - before, 0.0) / left
    return np.minimum(wanted, before + left * share / np.sqrt(np.sqrt(1.0 + share**4)))


def _knee_angle(length: np.ndarray) -> np.ndarray:
    length = np.clip(length, SHORTEST_M, LONGEST_M)
    return np.arccos((length**2 - THIGH_M**2 - SHIN_M**2) / (2 * THIGH_M * SHIN_M))


def _lean(knee: np.ndarray) -> np.ndarray:
    """Return the angle of the line from hip to ankle against the thigh, about its y axis."""
    return np.arctan2(SHIN_M * np.sin(knee), THIGH_M + SHIN_M * np.cos(knee))


def _shortest_turn(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the turns ``(T, 4)`` that bring the directions ``(T, 3)`` of a to those of b."""
    a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    cosine = np.sum(a * b, axis=-1, keepdims=True)
    return rotations.normalize(np.concatenate([1.0 + cosine, np.cross(a, b)], axis=-1))


def _relative(parent: np.ndarray, child: np.ndarray) -> np.ndarray:
    return rotations.to_matrix(rotations.multiply(rotations.conjugate(parent), child))


def _hip_angles(matrix: np.ndarray, near: np.ndarray) -> np.ndarray:
    """Return the angles ``(T, 3)`` about x, z and y of ``R_x R_z R_y (T, 3, 3)``, nearest to others."""
    z = np.arcsin(np.clip(-matrix[:, 0, 1], -1.0, 1.0))
    x = np.arctan2(matrix[:, 2, 1], matrix[:, 1, 1])
    y = np.arctan2(matrix[:, 0, 2], matrix[:, 0, 0])
    first = near + wrap(np.stack([x, z, y], axis=-1) - near)
    second = near + wrap(np.stack([x + np.pi, np.pi - z, y + np.pi], axis=-1) - near)
    is_first = np.abs(first - near).sum(axis=-1) <= np.abs(second - near).sum(axis=-1)
    return np.where(is_first[:, None], first, second)


def _ankle_angles(matrix: np.ndarray) -> np.ndarray:
    """Return the angles ``(T, 2)`` about y and x of ``R_y R_x R_z (T, 3, 3)``, leaving out the last."""
    x = np.arcsin(np.clip(-matrix[:, 1, 2], -1.0, 1.0))
    return np.stack([np.arctan2(matrix[:, 0, 2], matrix[:, 2, 2]), x], axis=-1)
