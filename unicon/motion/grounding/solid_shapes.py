"""Where the humanoid's solid shapes end at the bottom, and where its mass is."""

from __future__ import annotations

from functools import cache

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.humanoid.mjcf import compile_model
from unicon.humanoid.table import BODIES, ShapeSpec
from unicon.state import CharacterState


def lowest_point(frames: CharacterState) -> np.ndarray:
    """Return the height ``(T,)`` [m] of the lowest point of the body."""
    return lowest_height(forward_kinematics(frames))


def lowest_height(bodies: BodyKinematics, but: tuple[str, ...] = ()) -> np.ndarray:
    """Return the height ``(T,)`` [m] of the lowest point of all bodies except some."""
    heights = [
        _bottom(bodies, index, shape)
        for index, body in enumerate(BODIES)
        if body.name not in but
        for shape in body.shapes
        if shape.solid
    ]
    return np.min(heights, axis=0)


def body_height(bodies: BodyKinematics, name: str) -> np.ndarray:
    """Return the height ``(T,)`` [m] of the lowest point of one body."""
    index = HUMANOID.body_names.index(name)
    return np.min([_bottom(bodies, index, s) for s in BODIES[index].shapes if s.solid], axis=0)


def _bottom(bodies: BodyKinematics, index: int, shape: ShapeSpec) -> np.ndarray:
    """Return the height ``(T,)`` of a shape's bottom: of its centre, less what reaches below it.

    With n the world's up axis in the body's frame, a box of half sizes a reaches |n| . a below its
    centre, an ellipsoid |n a|, a capsule its radius below the lower end.
    """
    height, up_b = bodies.pos_w[:, index, 2], bodies.rot_w[:, index, 2, :]
    start, end = np.array(shape.start), np.array(shape.end)
    if shape.kind == "capsule":
        return height + np.minimum(up_b @ start, up_b @ end) - shape.radius
    if shape.kind == "box":
        return height + up_b @ start - np.abs(up_b) @ end
    return height + up_b @ start - np.sqrt((up_b * up_b) @ (end * end))


@cache
def _mass_centres() -> np.ndarray:
    """Return each body's centre of mass in its own frame ``(20, 3)`` [m]."""
    model = compile_model()
    return np.array([model.body(name).ipos for name in HUMANOID.body_names])


def mass_centre(bodies: BodyKinematics) -> np.ndarray:
    """Return the whole body's centre of mass ``(T, 3)`` [m], world frame."""
    centres_w = bodies.pos_w + (bodies.rot_w @ _mass_centres()[:, :, None])[..., 0]
    share = HUMANOID.body_mass / HUMANOID.body_mass.sum()
    return share @ centres_w
