"""Bends toes so that they lie on the floor and don't reach through it, as when a heel lifts.

Many captures have no toes, and then a foot that rolls over its ball would push them into the floor. In the
foot's frame, with h the height of the toes' hinge and (a, b) the tip's place along the foot and across its
sole, the tip's height is h + Q cos(angle - top): the hinge may turn as far as to where that is zero.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics
from unicon.humanoid.table import BODIES
from unicon.motion.grounding.smooth_change import smooth_cover
from unicon.motion.retargeting.euler import wrap

_SHAPE = next(body for body in BODIES if body.name == "left_toe").shapes[0]
_TIP_X = _SHAPE.start[0] + _SHAPE.end[0]
_TIP_Z = _SHAPE.start[2] - _SHAPE.end[2]
_HALF_WIDTH = _SHAPE.end[1]
_UPWARD_RANGE = 1.0
"""Toes that point straight down bend up, even where down is nearer by this angle [rad]."""
_SMOOTHNESS = 10.0
"""Weight of the bend's second differences: toes come back to straight within about 0.1 s."""


class _Toe(NamedTuple):
    """The tip's height over T frames: base + reach cos(angle - top)."""

    hinge: int
    base: np.ndarray
    reach: np.ndarray
    top: np.ndarray


def _toes(bodies: BodyKinematics) -> Iterator[_Toe]:
    for side in ("left", "right"):
        up_b = bodies.rot_w[:, HUMANOID.body_names.index(f"{side}_foot"), 2]
        hinge_height = bodies.pos_w[:, HUMANOID.body_names.index(f"{side}_toe"), 2]
        cosine = _TIP_X * up_b[:, 0] + _TIP_Z * up_b[:, 2]
        sine = _TIP_Z * up_b[:, 0] - _TIP_X * up_b[:, 2]
        yield _Toe(
            HUMANOID.joint_names.index(f"{side}_toe"),
            hinge_height - _HALF_WIDTH * np.abs(up_b[:, 1]),
            np.maximum(np.hypot(cosine, sine), 1e-9),
            np.arctan2(sine, cosine),
        )


def highest_tips(bodies: BodyKinematics) -> np.ndarray:
    """Return the height of both tips ``(T, 2)`` [m], each bent up as far as it goes."""
    return np.stack([toe.base + toe.reach * np.cos(_nearest_top(toe)) for toe in _toes(bodies)], axis=1)


def _nearest_top(toe: _Toe) -> np.ndarray:
    """Return how far from its top ``(T,)`` [rad] the tip stays within the hinge's limits."""
    lower, upper = HUMANOID.joint_lower[toe.hinge], HUMANOID.joint_upper[toe.hinge]
    middle = 0.5 * (lower + upper)
    away = wrap(toe.top - middle)
    return np.abs(away - np.clip(away, lower - middle, upper - middle))


def bend_toes(joint_pos: np.ndarray, bodies: BodyKinematics) -> np.ndarray:
    """Return the hinge angles ``(T, 35)`` with the toes out of the floor z = 0, within their limits."""
    result = joint_pos.copy()
    for toe in _toes(bodies):
        own = joint_pos[:, toe.hinge]
        bend = _needed_bend(own, toe)
        for sign in (-1.0, 1.0):
            part = np.maximum(sign * bend, 0.0)
            result[:, toe.hinge] += sign * (smooth_cover(part, _SMOOTHNESS) if part.any() else part)
        lower, upper = HUMANOID.joint_lower[toe.hinge], HUMANOID.joint_upper[toe.hinge]
        result[:, toe.hinge] = np.clip(result[:, toe.hinge], lower, upper)
    return result


def _needed_bend(angle: np.ndarray, toe: _Toe) -> np.ndarray:
    """Return the least turn ``(T,)`` [rad] that has the tip above the floor, within the hinge's limits."""
    free = np.arccos(np.clip(-toe.base / toe.reach, -1.0, 1.0))
    away = (angle - toe.top + np.pi - _UPWARD_RANGE) % (2 * np.pi) - np.pi + _UPWARD_RANGE
    bend = np.clip(away, -free, free) - away
    lower, upper = HUMANOID.joint_lower[toe.hinge], HUMANOID.joint_upper[toe.hinge]
    return np.clip(angle + bend, lower, upper) - angle
