"""Writes the humanoid's constants as a C++ header, from the compiled MuJoCo model and the table.

Masses, inertias, shapes and softness are read back from MuJoCo, so that the kernel simulates what MuJoCo
compiled; servo gains and limits come from ``HUMANOID``. tables.hpp says what each number is.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import compile_model

_FIRST_DOF = 6
_CAPSULE, _BOX = int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_BOX)
_TINY = 1e-9


def write_header() -> str:
    """Return the text of humanoid.hpp."""
    model = compile_model()
    solid = [g for g in range(model.ngeom) if model.geom_conaffinity[g]]
    capsules = [_capsule(model, g) for g in solid if model.geom_type[g] == _CAPSULE]
    boxes = [_solid(model, g) for g in solid if model.geom_type[g] == _BOX]
    ellipsoids = [_solid(model, g) for g in solid if model.geom_type[g] not in (_CAPSULE, _BOX)]
    touch, stop = solid[0], model.joint(HUMANOID.joint_names[0]).id
    parts = [
        "// Written by unicon/train/environment/batch_simulator/tables.py; see tables.hpp.\n#pragma once\n",
        _array("BODIES", "BodyTable BODY", [_body(model, i) for i in range(len(HUMANOID.body_names))]),
        _array("HINGES", "HingeTable HINGE", [_hinge(model, j) for j in range(len(HUMANOID.joint_names))]),
        _array("CAPSULES", "CapsuleTable CAPSULE", capsules),
        _array("BOXES", "SolidTable BOX", boxes),
        _array("ELLIPSOIDS", "SolidTable ELLIPSOID", ellipsoids),
        _softness("CONTACT_SOFTNESS", model.geom_solref[touch], model.geom_solimp[touch]),
        f"constexpr float CONTACT_FRICTION = {_number(model.geom_friction[touch, 0])};\n",
        _softness("LIMIT_SOFTNESS", model.jnt_solref[stop], model.jnt_solimp[stop]),
    ]
    return "\n".join(parts)


def _body(model: mujoco.MjModel, index: int) -> str:
    body = model.body(HUMANOID.body_names[index]).id
    hinges = np.flatnonzero(HUMANOID.joint_body == index)
    moment, inertia = _about_origin(model, body)
    fields = [
        str(HUMANOID.parents[index]),
        _numbers(HUMANOID.offsets[index] if index else np.zeros(3)),
        _number(model.body_mass[body]),
        _numbers(moment),
        _numbers(inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]),
        _number(model.body_invweight0[body, 0]),
        str(hinges[0] if len(hinges) else 0),
        str(len(hinges)),
    ]
    return _braced(fields)


def _about_origin(model: mujoco.MjModel, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Return m c ``(3,)`` and the inertia about the body's origin ``(3, 3)``, by Steiner's theorem."""
    mass, centre = model.body_mass[body], model.body_ipos[body]
    principal = _matrix(model.body_iquat[body])
    about_centre = principal @ np.diag(model.body_inertia[body]) @ principal.T
    steiner = mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    return mass * centre, about_centre + steiner


def _hinge(model: mujoco.MjModel, index: int) -> str:
    axis = HUMANOID.joint_axes[index]
    if sorted(axis) != [0.0, 0.0, 1.0]:
        raise ValueError(f"hinge {HUMANOID.joint_names[index]} turns about {axis}, not about x, y or z")
    numbers = [
        HUMANOID.joint_lower[index],
        HUMANOID.joint_upper[index],
        HUMANOID.effort[index],
        HUMANOID.stiffness[index],
        HUMANOID.damping[index],
        HUMANOID.armature[index],
        model.dof_invweight0[_FIRST_DOF + index],
    ]
    return _braced([str(int(np.argmax(axis))), *map(_number, numbers)])


def _capsule(model: mujoco.MjModel, geom: int) -> str:
    radius, half_length = model.geom_size[geom, :2]
    half = _matrix(model.geom_quat[geom])[:, 2] * half_length
    centre = model.geom_pos[geom]
    ends = _braced([_numbers(centre + half), _numbers(centre - half)])
    return _braced([str(model.geom_bodyid[geom] - 1), ends, _number(radius)])


def _solid(model: mujoco.MjModel, geom: int) -> str:
    axes = (_matrix(model.geom_quat[geom]) * model.geom_size[geom]).T
    half_axes = _braced([_numbers(axis) for axis in axes])
    return _braced([str(model.geom_bodyid[geom] - 1), _numbers(model.geom_pos[geom]), half_axes])


def _softness(name: str, solref: np.ndarray, solimp: np.ndarray) -> str:
    return f"constexpr SoftnessTable {name} = {_numbers([*solref, *solimp[:3]])};\n"


def _array(count: str, declaration: str, entries: Sequence[str]) -> str:
    rows = ",\n    ".join(entries)
    return f"constexpr int {count} = {len(entries)};\nconstexpr {declaration}[] = {{\n    {rows},\n}};\n"


def _matrix(quat: np.ndarray) -> np.ndarray:
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quat)
    return matrix.reshape(3, 3)


def _number(value: float) -> str:
    """Return a float literal; what is only rounding becomes a zero, which costs the kernel nothing."""
    return f"{0.0 if abs(value) < _TINY else value:#.9g}f"


def _numbers(values: Iterable[float]) -> str:
    return _braced([_number(value) for value in values])


def _braced(fields: Iterable[str]) -> str:
    return "{" + ", ".join(fields) + "}"
