"""The one table of the humanoid: 20 bodies, 35 hinges, 1.8 m, 70 kg. All else follows from it.

The zero pose stands with hanging arms and faces +x; z is up and y is to the left. All frames are parallel
in the zero pose, and every hinge goes through its body's origin. Left and right use the same axes, so
mirroring changes the sign of x and z hinges and of y coordinates, and swaps the sides.

Lengths follow Drillis and Contini (1966) for 1.8 m, masses Dempster (1955) for 70 kg. Effort factors are
within the paper's 50 to 600 N m. Stiffness and damping are those of the reference servo: about 1 to 3
times the effort a radian, and at the ankles together more than m g h = 640 N m/rad, without which no
servo can stand. The damping is passive and part of the model, so that it is integrated implicitly.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import Literal

Vector = tuple[float, float, float]

X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)

HEIGHT_M = 1.8
ROOT_HEIGHT_M = 0.95
"""Height of the root's origin in the zero pose, soles on the floor."""


@dataclass(frozen=True)
class HingeSpec:
    """One degree of freedom of a body against its parent."""

    name: str
    axis: Vector
    lower_rad: float
    upper_rad: float
    effort: float
    """Largest torque [N m]."""
    stiffness: float
    """Gain of the reference servo [N m/rad]."""
    damping: float
    """Passive damping, which is also the servo's [N m s/rad]."""
    armature: float
    """Inertia added to the hinge [kg m^2], as of a rotor."""


@dataclass(frozen=True)
class ShapeSpec:
    """One geometric shape of a body, in the body's frame."""

    kind: Literal["capsule", "box", "ellipsoid"]
    start: Vector
    """Capsule: centre of one end. Otherwise: the centre [m]."""
    end: Vector
    """Capsule: centre of the other end. Otherwise: the three half sizes [m]."""
    radius: float = 0.0
    """Capsule: radius [m]; box: unused."""
    solid: bool = True
    """Solid shapes have mass and touch; the others are there to be seen."""
    tint: Literal["skin", "cloth", "dark"] = "skin"
    """Which of the appearance's colours it has."""


@dataclass(frozen=True)
class BodySpec:
    """One rigid body; its frame's origin is where its hinges are."""

    name: str
    parent: str | None
    offset: Vector
    """Origin in the parent's frame [m]."""
    mass: float
    """[kg], shared by its solid shapes in proportion to their volumes."""
    hinges: tuple[HingeSpec, ...]
    shapes: tuple[ShapeSpec, ...]


def _hinge(
    name: str,
    axis: Vector,
    limits_deg: tuple[float, float],
    effort: float,
    stiffness: float,
    damping: float,
    armature: float,
) -> HingeSpec:
    lower, upper = (radians(limit) for limit in limits_deg)
    return HingeSpec(name, axis, lower, upper, effort, stiffness, damping, armature)


def _capsule(start: Vector, end: Vector, radius: float, **options: object) -> ShapeSpec:
    return ShapeSpec("capsule", start, end, radius, **options)  # type: ignore[arg-type]


def _box(centre: Vector, half_size: Vector, **options: object) -> ShapeSpec:
    return ShapeSpec("box", centre, half_size, **options)  # type: ignore[arg-type]


def _ellipsoid(centre: Vector, half_size: Vector, **options: object) -> ShapeSpec:
    return ShapeSpec("ellipsoid", centre, half_size, **options)  # type: ignore[arg-type]


_TRUNK = (
    BodySpec(
        "pelvis",
        None,
        (0.0, 0.0, ROOT_HEIGHT_M),
        10.0,
        (),
        (
            _capsule((0.0, -0.065, 0.0), (0.0, 0.065, 0.0), 0.095, tint="dark"),
            _ellipsoid((-0.01, 0.0, -0.03), (0.1, 0.155, 0.095), solid=False, tint="dark"),
        ),
    ),
    BodySpec(
        "abdomen",
        "pelvis",
        (0.0, 0.0, 0.10),
        8.0,
        (
            _hinge("abdomen_x", X, (-50, 50), 400, 800, 20, 0.05),
            _hinge("abdomen_y", Y, (-60, 100), 600, 1000, 25, 0.05),
            _hinge("abdomen_z", Z, (-60, 60), 400, 600, 15, 0.05),
        ),
        (
            _capsule((0.0, -0.05, 0.05), (0.0, 0.05, 0.05), 0.092, tint="cloth"),
            _ellipsoid((0.0, 0.0, 0.05), (0.097, 0.138, 0.13), solid=False, tint="cloth"),
        ),
    ),
    BodySpec(
        "chest",
        "abdomen",
        (0.0, 0.0, 0.14),
        14.5,
        (
            _hinge("chest_x", X, (-50, 50), 400, 700, 16, 0.05),
            _hinge("chest_y", Y, (-60, 80), 500, 800, 20, 0.05),
            _hinge("chest_z", Z, (-60, 60), 300, 500, 12, 0.05),
        ),
        (
            _capsule((0.0, -0.075, 0.13), (0.0, 0.075, 0.13), 0.11, tint="cloth"),
            _ellipsoid((0.0, 0.0, 0.12), (0.115, 0.175, 0.165), solid=False, tint="cloth"),
            _capsule((-0.01, -0.13, 0.235), (-0.01, 0.13, 0.235), 0.05, solid=False, tint="cloth"),
        ),
    ),
    BodySpec(
        "head",
        "chest",
        (0.0, 0.0, 0.28),
        5.6,
        (
            _hinge("head_x", X, (-50, 50), 50, 90, 3, 0.03),
            _hinge("head_y", Y, (-70, 70), 50, 90, 3, 0.03),
            _hinge("head_z", Z, (-90, 90), 50, 70, 3, 0.03),
        ),
        (
            _capsule((0.0, 0.0, 0.0), (0.005, 0.0, 0.07), 0.052),
            _ellipsoid((0.015, 0.0, 0.205), (0.1, 0.08, 0.125)),
            _ellipsoid((0.055, 0.0, 0.135), (0.055, 0.052, 0.055), solid=False),
            _capsule((0.112, 0.0, 0.2), (0.122, 0.0, 0.168), 0.012, solid=False),
            _box((0.095, 0.0, 0.222), (0.018, 0.062, 0.016), solid=False, tint="dark"),
        ),
    ),
)

_LEFT_ARM = (
    BodySpec(
        "left_clavicle",
        "chest",
        (0.0, 0.04, 0.24),
        1.2,
        (_hinge("left_clavicle", X, (-25, 60), 200, 300, 8, 0.03),),
        (_capsule((0.0, 0.02, 0.0), (0.0, 0.1, 0.0), 0.048, tint="cloth"),),
    ),
    BodySpec(
        "left_upper_arm",
        "left_clavicle",
        (0.0, 0.15, 0.0),
        1.96,
        (
            _hinge("left_shoulder_x", X, (-120, 220), 200, 300, 8, 0.03),
            _hinge("left_shoulder_z", Z, (-140, 140), 150, 200, 6, 0.03),
            _hinge("left_shoulder_y", Y, (-270, 200), 200, 300, 8, 0.03),
        ),
        (
            _capsule((0.0, 0.0, -0.03), (0.0, 0.0, -0.27), 0.045),
            _ellipsoid((0.0, 0.0, -0.03), (0.06, 0.062, 0.085), solid=False, tint="cloth"),
        ),
    ),
    BodySpec(
        "left_forearm",
        "left_upper_arm",
        (0.0, 0.0, -0.30),
        1.12,
        (_hinge("left_elbow", Y, (-165, 10), 150, 180, 5, 0.03),),
        (
            _capsule((0.0, 0.0, -0.03), (0.0, 0.0, -0.22), 0.036),
            _ellipsoid((0.0, 0.0, -0.07), (0.044, 0.043, 0.09), solid=False),
        ),
    ),
    BodySpec(
        "left_hand",
        "left_forearm",
        (0.0, 0.0, -0.26),
        0.42,
        (_hinge("left_wrist", X, (-90, 90), 50, 50, 2, 0.02),),
        (
            _capsule((0.0, 0.0, -0.04), (0.0, 0.0, -0.12), 0.03),
            _box((0.0, 0.0, -0.065), (0.042, 0.018, 0.05), solid=False),
            _capsule((0.008, 0.0, -0.1), (0.004, -0.004, -0.175), 0.015, solid=False),
            _capsule((-0.018, 0.0, -0.1), (-0.018, -0.004, -0.165), 0.014, solid=False),
            _capsule((0.03, 0.0, -0.05), (0.055, 0.0, -0.1), 0.013, solid=False),
        ),
    ),
)

_LEFT_LEG = (
    BodySpec(
        "left_thigh",
        "pelvis",
        (0.0, 0.095, -0.03),
        7.0,
        (
            _hinge("left_hip_x", X, (-60, 100), 400, 800, 18, 0.05),
            _hinge("left_hip_z", Z, (-90, 90), 300, 500, 12, 0.05),
            _hinge("left_hip_y", Y, (-160, 80), 500, 1000, 22, 0.05),
        ),
        (
            _capsule((0.0, 0.0, -0.06), (0.0, 0.0, -0.36), 0.066, tint="dark"),
            _ellipsoid((0.0, 0.0, -0.13), (0.087, 0.083, 0.2), solid=False, tint="dark"),
        ),
    ),
    BodySpec(
        "left_shin",
        "left_thigh",
        (0.0, 0.0, -0.425),
        3.25,
        (_hinge("left_knee", Y, (-5, 165), 500, 900, 18, 0.05),),
        (
            _capsule((0.0, 0.0, -0.04), (0.0, 0.0, -0.36), 0.046, tint="dark"),
            _ellipsoid((-0.015, 0.0, -0.13), (0.06, 0.057, 0.14), solid=False, tint="dark"),
        ),
    ),
    BodySpec(
        "left_foot",
        "left_shin",
        (0.0, 0.0, -0.42),
        0.8,
        (
            _hinge("left_ankle_y", Y, (-60, 80), 300, 700, 15, 0.05),
            _hinge("left_ankle_x", X, (-50, 50), 200, 600, 12, 0.05),
        ),
        (
            _box((0.035, 0.0, -0.0525), (0.1, 0.045, 0.0225), tint="cloth"),
            _ellipsoid((0.01, 0.0, -0.035), (0.085, 0.042, 0.045), solid=False, tint="cloth"),
        ),
    ),
    BodySpec(
        "left_toe",
        "left_foot",
        (0.135, 0.0, -0.055),
        0.2,
        (_hinge("left_toe", Y, (-80, 45), 50, 60, 2, 0.02),),
        (_box((0.035, 0.0, 0.0), (0.035, 0.045, 0.02), tint="cloth"),),
    ),
)


def _mirror_vector(v: Vector) -> Vector:
    return (v[0], -v[1], v[2])


def _mirror_name(name: str) -> str:
    return name.replace("left_", "right_", 1)


def _mirror_hinge(h: HingeSpec) -> HingeSpec:
    lower, upper = (h.lower_rad, h.upper_rad) if h.axis == Y else (-h.upper_rad, -h.lower_rad)
    rest = (h.effort, h.stiffness, h.damping, h.armature)
    return HingeSpec(_mirror_name(h.name), h.axis, lower, upper, *rest)


def _mirror_shape(s: ShapeSpec) -> ShapeSpec:
    end = _mirror_vector(s.end) if s.kind == "capsule" else s.end
    return ShapeSpec(s.kind, _mirror_vector(s.start), end, s.radius, s.solid, s.tint)


def _mirror_body(body: BodySpec) -> BodySpec:
    return BodySpec(
        name=_mirror_name(body.name),
        parent=_mirror_name(body.parent) if body.parent else None,
        offset=_mirror_vector(body.offset),
        mass=body.mass,
        hinges=tuple(_mirror_hinge(h) for h in body.hinges),
        shapes=tuple(_mirror_shape(s) for s in body.shapes),
    )


_RIGHT_ARM = tuple(_mirror_body(body) for body in _LEFT_ARM)
_RIGHT_LEG = tuple(_mirror_body(body) for body in _LEFT_LEG)

BODIES: tuple[BodySpec, ...] = (*_TRUNK, *_LEFT_ARM, *_RIGHT_ARM, *_LEFT_LEG, *_RIGHT_LEG)
"""All bodies, parents before children, in the order of every body array."""

HINGES: tuple[HingeSpec, ...] = tuple(hinge for body in BODIES for hinge in body.hinges)
"""All hinges, in the order of every joint array."""
