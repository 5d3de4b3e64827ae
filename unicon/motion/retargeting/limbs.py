"""Arms and legs in closed form: two bones and a hinge from the shoulder or hip to a given wrist or ankle.

With r the source's way from hip to ankle and L its leg's length, e = |r| / L says how far the leg is
stretched. Our ankle goes towards the source's ankle, to the distance e l (l: our leg's length) where the
leg is nearly straight, so that straight stays straight whatever the proportions, and to the source's
ankle itself where it is bent. The hinge's angle follows from the law of cosines.

The hinge's axis h is perpendicular to the bending plane: h ~ m n + K a, with n = b1 x b2 the normal of
the source's unit bones, as long as the sine of the bend, m = min(|n| / 0.35, 1), and a the axis that the
source's upper joint carries along. So a bent limb takes its own plane and a straight one the source's
twist, with a smooth passage between; the part of n that points against a is left out, so that a limb
that is bent backwards a little never flips.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.motion.retargeting.frames import frame, unit

TWIST_WEIGHT = 0.15
"""K: how much the source's twist counts beside the sine of the bend."""
TRUSTED_SINE = 0.35
"""Sine of the bend from which on the plane counts fully: that of a nearly straight limb is mostly noise."""
BENT, STRAIGHT = 0.85, 0.97
"""How far a limb is stretched where it begins and ends to keep its straightness rather than its place."""
KEPT = 0.4
"""Part of the source's slack that ours has at least."""
SMALLEST = 0.2
"""A limb is never folded to less than this part of its length."""


@dataclass(frozen=True)
class Limb:
    """An arm or a leg by the names of its parts."""

    parts: tuple[str, str, str]
    """Bodies whose origins are shoulder, elbow, wrist (or hip, knee, ankle)."""
    sign: float
    """Which way the hinge turns when it bends: 1 at knees, -1 at elbows."""

    @property
    def upper(self) -> str:
        """Name of the upper body."""
        return self.parts[0]

    @property
    def lengths_m(self) -> tuple[float, float]:
        """Lengths of our two bones [m]."""
        lower, end = (HUMANOID.body_names.index(name) for name in self.parts[1:])
        return float(np.linalg.norm(HUMANOID.offsets[lower])), float(np.linalg.norm(HUMANOID.offsets[end]))


def _limb(side: str, kind: str) -> Limb:
    names = {"arm": ("upper_arm", "forearm", "hand"), "leg": ("thigh", "shin", "foot")}[kind]
    parts = (f"{side}_{names[0]}", f"{side}_{names[1]}", f"{side}_{names[2]}")
    return Limb(parts, -1.0 if kind == "arm" else 1.0)


LIMBS = tuple(_limb(side, kind) for side in ("left", "right") for kind in ("arm", "leg"))


class LimbPose(NamedTuple):
    """A limb over time."""

    upper_quat_w: np.ndarray
    """Rotation of the upper body ``(T, 4)``."""
    hinge: np.ndarray
    """Angle of elbow or knee ``(T,)`` [rad]."""


def bend_normal(start: np.ndarray, middle: np.ndarray, end: np.ndarray, sign: float) -> np.ndarray:
    """Return the normal ``(T, 3)`` of a limb's plane, along the hinge's axis, as long as the bend's sine."""
    return sign * rotations.cross(unit(middle - start), unit(end - middle))


def solve_limb(
    limb: Limb, origin: np.ndarray, joints: Sequence[np.ndarray], twist_axis: np.ndarray
) -> LimbPose:
    """Return the limb's pose.

    Args:
        limb: Which one.
        origin: Where our shoulder or hip is ``(T, 3)`` [m].
        joints: The scaled source's shoulder, elbow and wrist, each ``(T, 3)`` [m].
        twist_axis: The hinge's axis as the source's upper joint has it ``(T, 3)``, unit.
    """
    start, middle, end = joints
    upper_m, lower_m = limb.lengths_m
    stretch = _length(end - start) / (_length(middle - start) + _length(end - middle))
    distance = _distance(stretch, _length(end - origin), upper_m + lower_m)
    interior = _law_of_cosines(upper_m, lower_m, distance)
    lift = _law_of_cosines(upper_m, distance, lower_m)
    normal = bend_normal(start, middle, end, limb.sign)
    against = np.minimum(np.sum(normal * twist_axis, axis=-1, keepdims=True), 0.0)
    trust = np.minimum(_length(normal) / TRUSTED_SINE, 1.0)[:, None]
    axis = trust * (normal - against * twist_axis) + TWIST_WEIGHT * twist_axis
    along = frame(origin - end, axis)
    swing = rotations.from_axis_angle(np.array([0.0, 1.0, 0.0]), -limb.sign * lift)
    return LimbPose(rotations.multiply(along, swing), limb.sign * (np.pi - interior))


def _distance(stretch: np.ndarray, wanted_m: np.ndarray, length_m: float) -> np.ndarray:
    """Return how far from the origin the end shall be ``(T,)``.

    Counted in slack, what is missing to the whole length: at least KEPT of what the source's limb has, so
    that ours is never straight where it is bent, with a smooth passage.
    """
    weight = np.clip((stretch - BENT) / (STRAIGHT - BENT), 0.0, 1.0)
    weight = weight * weight * (3.0 - 2.0 * weight)
    own = (1.0 - np.minimum(stretch, 1.0)) * length_m
    slack = weight * own + (1.0 - weight) * (length_m - wanted_m)
    least, width = KEPT * own, 0.1 * own
    slack = 0.5 * (slack + least + np.sqrt((slack - least) ** 2 + width * width * (1.0 - weight) ** 2))
    return length_m - np.minimum(slack, (1.0 - SMALLEST) * length_m)


def _law_of_cosines(a: float, b: np.ndarray | float, c: np.ndarray | float) -> np.ndarray:
    """Return the angle between the sides a and b of a triangle whose third side is c."""
    return np.arccos(np.clip((a * a + b * b - c * c) / (2.0 * a * b), -1.0, 1.0))


def _length(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1)
