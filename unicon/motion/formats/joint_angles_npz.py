"""Reads joint angles of the OpenSim-like full humanoid of loco-mujoco: arrays ``q_<coordinate>`` over time.

Each coordinate is a turn [rad] about a fixed axis of its body, or a slide [m] of the pelvis; a body with the
hinges a, b, c has the rotation R_a R_b R_c against its parent. The files hold angles alone: places and axes
of the joints are those of the full-body model (Rajagopal et al. 2016, as in loco-mujoco's full_humanoid),
whose axes are x forward, y up, z right. The head is fixed to the torso there.

The files don't say their rate either, but they hold the velocities ``dq_<coordinate>``: the rate is the usual
one nearest to that with which these explain the steps of the angles best, by least squares.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.array_file import Arrays
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

PELVIS_HEIGHT_M = 0.95
"""Where the model's pelvis is when all its slides are zero."""
USUAL_RATES_HZ = (30.0, 50.0, 60.0, 100.0, 120.0, 200.0, 250.0, 500.0, 1000.0)

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

Vector = tuple[float, float, float]


class _Body(NamedTuple):
    name: str
    parent: str
    offset: Vector
    """Place in the parent's frame [m], in the model's axes."""
    hinges: tuple[tuple[str, Vector], ...] = ()
    """Coordinates and their axes, in the order in which they turn."""


_TRUNK = (
    _Body("pelvis", "", (0, 0, 0), (("pelvis_tilt", _Z), ("pelvis_list", _X), ("pelvis_rotation", _Y))),
    _Body(
        "torso",
        "pelvis",
        (-0.1007, 0.0815, 0.0),
        (("lumbar_extension", _Z), ("lumbar_bending", _X), ("lumbar_rotation", _Y)),
    ),
    _Body("head", "torso", (0.01, 0.46, 0.0)),
)
_RIGHT = (
    _Body(
        "femur",
        "pelvis",
        (-0.056276, -0.07849, 0.07726),
        (("hip_flexion", _Z), ("hip_adduction", _X), ("hip_rotation", _Y)),
    ),
    _Body("tibia", "femur", (0.0, -0.404425, -0.001265), (("knee_angle", (0.0, -0.0707131, -0.997497)),)),
    _Body("talus", "tibia", (-0.01, -0.4, 0.0), (("ankle_angle", (-0.105014, -0.174022, 0.979126)),)),
    _Body(
        "calcn", "talus", (-0.04877, -0.04195, 0.00792), (("subtalar_angle", (0.78718, 0.604747, -0.120949)),)
    ),
    _Body("toes", "calcn", (0.1788, -0.002, 0.00108), (("mtp_angle", (0.580954, 0.0, -0.813936)),)),
    _Body("humerus", "torso", (0.003155, 0.3715, 0.17), (("arm_flex", _Z), ("arm_add", _X), ("arm_rot", _Y))),
    _Body(
        "ulna", "humerus", (0.013144, -0.286273, -0.009595), (("elbow_flex", (0.226047, 0.022269, 0.973862)),)
    ),
    _Body("radius", "ulna", (-0.006727, -0.013007, 0.026083), (("pro_sup", (0.056398, 0.998406, 0.001952)),)),
    _Body("hand", "radius", (-0.008797, -0.235841, 0.01361), (("wrist_flex", _Z), ("wrist_dev", _X))),
)
_MOVING = (
    "pelvis_tx",
    *(f"{part}_{side}" for part in ("hip_flexion", "knee_angle", "ankle_angle", "arm_flex") for side in "rl"),
)
"""The coordinates that move most, so that noise matters least."""
_SAME_BOTH_SIDES = ("hip_adduction", "hip_rotation")
"""These turn both thighs the same way; all others are mirror images, so that equal angles look alike."""


def _side(suffix: str, mirrored: bool) -> list[_Body]:
    flip = -1.0 if mirrored else 1.0

    def axis_of(coordinate: str, axis: Vector) -> Vector:
        x, y, z = axis
        return axis if coordinate in _SAME_BOTH_SIDES else (flip * x, flip * y, z)

    names = {body.name for body in _RIGHT}
    return [
        _Body(
            name + suffix,
            parent + suffix if parent in names else parent,
            (x, y, flip * z),
            tuple((coordinate + suffix, axis_of(coordinate, axis)) for coordinate, axis in hinges),
        )
        for name, parent, (x, y, z), hinges in _RIGHT
    ]


_BODIES = (*_TRUNK, *_side("_r", mirrored=False), *_side("_l", mirrored=True))


def read_joint_angles(file: MotionFile) -> SourceMotion:
    """Read a motion.

    Raises:
        InputFileError: when a coordinate is missing or its values are no such angles; the message names it.
    """
    arrays = Arrays(file)
    frames = len(arrays.numbers("q_pelvis_tilt", (None,)))
    if frames < 2:
        raise InputFileError(f"{file.origin}: has {frames} frames, expected 2 or more")
    angles = {name: arrays.numbers(f"q_{name}", (frames,)) for body in _BODIES for name, _ in body.hinges}
    _check_knees(file, angles)
    names = [body.name for body in _BODIES]
    slides = [arrays.numbers(f"q_pelvis_{axis}", (frames,)) for axis in ("tx", "ty", "tz")]
    return SourceMotion(
        name=file.name,
        family="",
        joint_names=tuple(names),
        parents=np.array([names.index(body.parent) if body.parent else -1 for body in _BODIES]),
        offsets=_to_z_up(np.array([body.offset for body in _BODIES])),
        times_s=np.arange(frames) / _rate_hz(arrays, frames),
        root_pos=_to_z_up(np.stack(slides, axis=-1)) + np.array([0.0, 0.0, PELVIS_HEIGHT_M]),
        local_quat=np.stack([_rotation(body, angles, frames) for body in _BODIES], axis=1),
    )


def _check_knees(file: MotionFile, angles: dict[str, np.ndarray]) -> None:
    for side in ("r", "l"):
        lowest = angles[f"knee_angle_{side}"].min()
        if lowest < -0.5:
            raise InputFileError(
                f"{file.origin}: 'q_knee_angle_{side}' reaches {lowest:.2f} rad, expected knees that bend by "
                "positive angles as the full humanoid's do; these are of another model"
            )


def _rate_hz(arrays: Arrays, frames: int) -> float:
    """Return the usual rate nearest to the r with the least sum of (dq - r (step of q))^2."""
    across = along = 0.0
    for name in _MOVING:
        steps = np.diff(arrays.numbers(f"q_{name}", (frames,)))
        velocity = arrays.numbers(f"dq_{name}", (frames,))
        across += steps @ (0.5 * (velocity[1:] + velocity[:-1]))
        along += steps @ steps
    if not (across > 0 and along > 0):
        raise InputFileError(
            f"{arrays.origin}: the velocities 'dq_...' don't fit the angles 'q_...', so its rate is unknown"
        )
    return min(USUAL_RATES_HZ, key=lambda rate_hz: abs(np.log(rate_hz * along / across)))


def _rotation(body: _Body, angles: dict[str, np.ndarray], frames: int) -> np.ndarray:
    turn = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    for coordinate, axis in body.hinges:
        unit = _to_z_up(np.array(axis)) / np.linalg.norm(axis)
        turn = rotations.multiply(turn, rotations.from_axis_angle(unit, angles[coordinate]))
    return turn


def _to_z_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x forward, y up, z right into x forward, y left, z up."""
    return vectors[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])
