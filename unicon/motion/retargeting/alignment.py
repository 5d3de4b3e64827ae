"""How a source's joint frames lie against our bodies' frames, read off its rest pose.

In the rest pose all joint frames of a source are parallel and a person stands, arms anyhow. The figure's
y axis goes from right to left hip and shoulder, its z axis from the ankles to the shoulders: so lie the
head, and our hanging limbs. The trunk's z axis goes from the hips to the shoulders, since in ours these
are above each other. A limb lies as ours would if it were turned from hanging to the rest bone by the
shortest turn; that gives its hinge's axis (arms out with palms down, hanging with palms in, legs spread,
all come out right). Where a limb bends during the motion, the plane in which it does so corrects that
axis. Feet are flat at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon import rotations
from unicon.motion.retargeting.frames import across, frame, unit
from unicon.motion.retargeting.limbs import LIMBS, bend_normal

DOWN = np.array([0.0, 0.0, -1.0])
SIDEWAYS = np.array([0.0, 1.0, 0.0])
PRIOR = 0.05
"""Mean squared sine of the bend at which the limb's plane counts as much as the rest pose for its axis."""


@dataclass(frozen=True)
class Alignment:
    """Constants of a skeleton; turns are ``(4,)``, from our body's frame to the source's joint frame."""

    trunk: np.ndarray
    """Pelvis, chest and clavicles."""
    head: np.ndarray
    feet: dict[str, np.ndarray]
    """By side."""
    hinge_axes: dict[str, np.ndarray]
    """Unit axis ``(3,)`` of elbow or knee in the frame of the joint above it, by upper body."""


def align(
    rest: np.ndarray, parts: dict[str, int], positions: np.ndarray, turns: dict[str, np.ndarray]
) -> Alignment:
    """Return the alignment of a skeleton.

    Args:
        rest: Where its joints are at rest ``(J, 3)`` [m].
        parts: Index of the joint that plays each part.
        positions: Where the joints are in the motion ``(T, J, 3)`` [m], world.
        turns: Their rotations ``(T, 4)`` by part, world.
    """
    figure = figure_frame(rest, parts, "foot")
    axes = {}
    for limb in LIMBS:
        upper, middle, lower = (parts[name] for name in limb.parts)
        rest_axis = rotations.rotate(_limb_turn(figure, rest[middle] - rest[upper]), SIDEWAYS)
        normal_w = bend_normal(positions[:, upper], positions[:, middle], positions[:, lower], limb.sign)
        normal_w = normal_w * np.linalg.norm(normal_w, axis=-1, keepdims=True)
        mean = rotations.rotate_inverse(turns[limb.upper], normal_w).mean(axis=0)
        bone = rest[middle] - rest[upper]
        axes[limb.upper] = _hinge_axis(mean + PRIOR * rest_axis, bone, rest_axis)
    feet = {side: _foot_turn(figure, rest, parts, side) for side in ("left", "right")}
    return Alignment(figure_frame(rest, parts, "thigh"), figure, feet, axes)


def figure_frame(rest: np.ndarray, parts: dict[str, int], foot: str) -> np.ndarray:
    """Return the turn ``(4,)`` from our zero pose's axes to those of the figure at rest.

    The vertical goes from the middle of both joints of ``foot`` ("thigh" or "foot") to that of the shoulders.
    """
    shoulders = rest[parts["left_upper_arm"]] - rest[parts["right_upper_arm"]]
    hips = rest[parts["left_thigh"]] - rest[parts["right_thigh"]]
    bottom = 0.5 * (rest[parts[f"left_{foot}"]] + rest[parts[f"right_{foot}"]])
    top = 0.5 * (rest[parts["left_upper_arm"]] + rest[parts["right_upper_arm"]])
    return frame(top - bottom, unit(shoulders) + unit(hips))


def _limb_turn(figure: np.ndarray, bone: np.ndarray) -> np.ndarray:
    """Return the turn of a limb that hangs in our zero pose and lies along ``bone (3,)`` at rest."""
    hanging = rotations.rotate(figure, DOWN)
    direction = unit(bone)
    cosine = hanging @ direction
    if cosine < -1 + 1e-6:
        about = rotations.rotate(figure, np.array([1.0, 0.0, 0.0]))
        return rotations.multiply(np.array([0.0, *about]), figure)
    turn = rotations.normalize(np.array([1 + cosine, *np.cross(hanging, direction)]))
    return rotations.multiply(turn, figure)


def _foot_turn(figure: np.ndarray, rest: np.ndarray, parts: dict[str, int], side: str) -> np.ndarray:
    """Return a flat foot's turn: rolled with the shin, level otherwise, pointing at the toes.

    Legs that are spread at rest carry their feet with them.
    """
    knee, ankle = rest[parts[f"{side}_shin"]], rest[parts[f"{side}_foot"]]
    sideways = rotations.rotate(_limb_turn(figure, ankle - knee), SIDEWAYS)
    up = rotations.rotate(figure, -DOWN)
    up = unit(across(up, sideways))
    toe = parts.get(f"{side}_toe")
    if toe is None:
        return frame(up, sideways)
    return frame(up, np.cross(up, rest[toe] - ankle))


def _hinge_axis(axis: np.ndarray, bone: np.ndarray, fallback: np.ndarray) -> np.ndarray:
    """Return the unit part of ``axis`` that is perpendicular to ``bone``, never against ``fallback``."""
    axis = across(axis, unit(bone))
    if axis @ fallback < 0.0 or np.linalg.norm(axis) < 1e-6:
        return fallback
    return unit(axis)
