"""The humanoid: one table (table.py), and all that follows from it.

``HUMANOID`` holds the table as arrays; mjcf.py makes the physics model, kinematics.py places the bodies,
urdf.py describes it to other programs.
"""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass, fields
from functools import cached_property

import numpy as np

from unicon.humanoid.kinematics import PARENTS
from unicon.humanoid.table import BODIES, HEIGHT_M, HINGES, ROOT_HEIGHT_M
from unicon.state import CharacterState

__all__ = ["HUMANOID", "Humanoid"]


@dataclass(frozen=True)
class Humanoid:
    """The table as read-only arrays: B = 20 bodies, J = 35 hinges."""

    id: str
    """Short hash of everything in the table that physics or kinematics depend on."""
    body_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    parents: np.ndarray
    """Index of each body's parent ``(B,)``, -1 for the root."""
    offsets: np.ndarray
    """Origin of each body in its parent's frame ``(B, 3)`` [m]."""
    body_mass: np.ndarray
    """``(B,)`` [kg]."""
    joint_body: np.ndarray
    """Index of the body that each hinge moves ``(J,)``."""
    joint_axes: np.ndarray
    """``(J, 3)``, in the body's frame before its hinges turn."""
    joint_lower: np.ndarray
    """``(J,)`` [rad]."""
    joint_upper: np.ndarray
    """``(J,)`` [rad]."""
    effort: np.ndarray
    """Largest torque ``(J,)`` [N m]; the policy's outputs are scaled by it."""
    stiffness: np.ndarray
    """Gain of the reference servo ``(J,)`` [N m/rad]."""
    damping: np.ndarray
    """Passive damping ``(J,)`` [N m s/rad]."""
    armature: np.ndarray
    """``(J,)`` [kg m^2]."""
    height_m: float

    def rest_state(self) -> CharacterState:
        """Stand at the world's origin with hanging arms, soles on the floor, facing +x."""
        return CharacterState(
            root_pos_w=np.array([0.0, 0.0, ROOT_HEIGHT_M]),
            root_quat_w=np.array([1.0, 0.0, 0.0, 0.0]),
            root_lin_vel_w=np.zeros(3),
            root_ang_vel_w=np.zeros(3),
            joint_pos=np.zeros(len(self.joint_names)),
            joint_vel=np.zeros(len(self.joint_names)),
        )

    @cached_property
    def mirror_order(self) -> np.ndarray:
        """Index of each hinge's counterpart on the other side ``(J,)``."""
        swap = {"left": "right", "right": "left"}
        other = [
            "_".join([swap.get(name.split("_")[0], name.split("_")[0]), *name.split("_")[1:]])
            for name in self.joint_names
        ]
        return np.array([self.joint_names.index(name) for name in other])

    @cached_property
    def mirror_sign(self) -> np.ndarray:
        """1 for hinges about y, -1 for those about x and z ``(J,)``."""
        return np.where(self.joint_axes[:, 1] == 1.0, 1.0, -1.0)

    def mirror(self, state: CharacterState) -> CharacterState:
        """Reflect states ``(...)`` at the plane y = 0: left becomes right."""
        flip_y = np.array([1.0, -1.0, 1.0])
        return CharacterState(
            root_pos_w=state.root_pos_w * flip_y,
            root_quat_w=state.root_quat_w * np.array([1.0, -1.0, 1.0, -1.0]),
            root_lin_vel_w=state.root_lin_vel_w * flip_y,
            root_ang_vel_w=state.root_ang_vel_w * -flip_y,
            joint_pos=state.joint_pos[..., self.mirror_order] * self.mirror_sign,
            joint_vel=state.joint_vel[..., self.mirror_order] * self.mirror_sign,
        )


def _hash_table() -> str:
    """Hash what physics depends on: not the shapes that are only seen, nor any colour."""
    parts = []
    for body in BODIES:
        entry = asdict(body)
        solid = [shape for shape in entry.pop("shapes") if shape.pop("solid")]
        parts.append((entry, [{k: v for k, v in shape.items() if k != "tint"} for shape in solid]))
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


def _build_humanoid() -> Humanoid:
    def of_hinges(field: str) -> np.ndarray:
        return np.array([getattr(hinge, field) for hinge in HINGES], dtype=float)

    humanoid = Humanoid(
        id=_hash_table(),
        body_names=tuple(body.name for body in BODIES),
        joint_names=tuple(hinge.name for hinge in HINGES),
        parents=np.array(PARENTS),
        offsets=np.array([body.offset for body in BODIES]),
        body_mass=np.array([body.mass for body in BODIES]),
        joint_body=np.array([i for i, body in enumerate(BODIES) for _ in body.hinges]),
        joint_axes=of_hinges("axis"),
        joint_lower=of_hinges("lower_rad"),
        joint_upper=of_hinges("upper_rad"),
        effort=of_hinges("effort"),
        stiffness=of_hinges("stiffness"),
        damping=of_hinges("damping"),
        armature=of_hinges("armature"),
        height_m=HEIGHT_M,
    )
    for field in fields(humanoid):
        value = getattr(humanoid, field.name)
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
    return humanoid


HUMANOID = _build_humanoid()
"""The humanoid of this project."""
