"""The humanoid as URDF, for RViz, robot_state_publisher and other robot tools.

URDF has one hinge a joint, so a body with several hinges gets links of next to no mass between them.
Ellipsoids become spheres of their mean radius and capsules a cylinder with two spheres.
"""

from __future__ import annotations

from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import mujoco
import numpy as np

from unicon.humanoid.mjcf import Appearance, compile_model
from unicon.humanoid.table import BODIES, BodySpec, HingeSpec, ShapeSpec

MAX_SPEED_RAD_S = 50.0


def build_urdf() -> str:
    """Return the URDF as text: 20 links with mass, 35 revolute joints, limits and efforts."""
    robot = Element("robot", name="unicon_humanoid")
    model = compile_model()
    for body in BODIES:
        _add_joints(robot, body)
        _add_link(robot, body, model)
    ElementTree.indent(robot)
    return ElementTree.tostring(robot, encoding="unicode")


def _add_joints(robot: Element, body: BodySpec) -> None:
    parent = body.parent
    for index, hinge in enumerate(body.hinges):
        last = index == len(body.hinges) - 1
        child = body.name if last else f"{body.name}_{index}"
        if not last:
            _add_tiny_inertia(SubElement(robot, "link", name=child))
        offset = body.offset if index == 0 else (0.0, 0.0, 0.0)
        _add_joint(robot, hinge, str(parent), child, offset)
        parent = child


def _add_tiny_inertia(link: Element) -> None:
    """Give a link between two hinges of one body next to no mass: many readers refuse none at all."""
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "mass", value="1e-06")
    SubElement(inertial, "inertia", ixx="1e-09", ixy="0", ixz="0", iyy="1e-09", iyz="0", izz="1e-09")


def _add_joint(robot: Element, hinge: HingeSpec, parent: str, child: str, offset: tuple[float, ...]) -> None:
    joint = SubElement(robot, "joint", name=hinge.name, type="revolute")
    SubElement(joint, "origin", xyz=_text(offset), rpy="0 0 0")
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    SubElement(joint, "axis", xyz=_text(hinge.axis))
    SubElement(
        joint,
        "limit",
        lower=f"{hinge.lower_rad:.6g}",
        upper=f"{hinge.upper_rad:.6g}",
        effort=f"{hinge.effort:g}",
        velocity=f"{MAX_SPEED_RAD_S:g}",
    )
    SubElement(joint, "dynamics", damping=f"{hinge.damping:g}", friction="0")


def _add_link(robot: Element, body: BodySpec, model: mujoco.MjModel) -> None:
    link = SubElement(robot, "link", name=body.name)
    _add_inertia(link, model, model.body(body.name).id)
    for shape in body.shapes:
        _add_shape(link, "visual", body, shape)
        if shape.solid:
            _add_shape(link, "collision", body, shape)


def _add_inertia(link: Element, model: mujoco.MjModel, body_id: int) -> None:
    """Take mass and inertia from the compiled model, turned into the link's axes."""
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.body_iquat[body_id])
    turn = rotation.reshape(3, 3)
    inertia = turn @ np.diag(model.body_inertia[body_id]) @ turn.T
    element = SubElement(link, "inertial")
    SubElement(element, "origin", xyz=_text(model.body_ipos[body_id]), rpy="0 0 0")
    SubElement(element, "mass", value=f"{model.body_mass[body_id]:.6g}")
    names = {
        "ixx": (0, 0),
        "ixy": (0, 1),
        "ixz": (0, 2),
        "iyy": (1, 1),
        "iyz": (1, 2),
        "izz": (2, 2),
    }
    SubElement(element, "inertia", {name: f"{inertia[at]:.6g}" for name, at in names.items()})


def _add_shape(link: Element, role: str, body: BodySpec, shape: ShapeSpec) -> None:
    if shape.kind == "capsule":
        _add_capsule(link, role, body, shape)
        return
    geometry = _add_geometry(link, role, body, shape, shape.start)
    if shape.kind == "box":
        SubElement(geometry, "box", size=_text(2 * np.array(shape.end)))
    else:
        SubElement(geometry, "sphere", radius=f"{np.mean(shape.end):.6g}")


def _add_capsule(link: Element, role: str, body: BodySpec, shape: ShapeSpec) -> None:
    start, end = np.array(shape.start), np.array(shape.end)
    along = end - start
    length = float(np.linalg.norm(along))
    tilt, turn = float(np.arccos(along[2] / length)), float(np.arctan2(along[1], along[0]))
    tube = _add_geometry(link, role, body, shape, tuple((start + end) / 2), (0.0, tilt, turn))
    SubElement(tube, "cylinder", radius=f"{shape.radius:.6g}", length=f"{length:.6g}")
    for centre in (shape.start, shape.end):
        ball = _add_geometry(link, role, body, shape, centre)
        SubElement(ball, "sphere", radius=f"{shape.radius:.6g}")


def _add_geometry(
    link: Element,
    role: str,
    body: BodySpec,
    shape: ShapeSpec,
    centre: tuple[float, ...],
    rpy: tuple[float, ...] = (0.0, 0.0, 0.0),
) -> Element:
    element = SubElement(link, role)
    SubElement(element, "origin", xyz=_text(centre), rpy=_text(rpy))
    geometry = SubElement(element, "geometry")
    if role == "visual":
        material = SubElement(element, "material", name=f"unicon_{shape.tint}")
        SubElement(material, "color", rgba=_text(Appearance().colour_of(body, shape)))
    return geometry


def _text(values: tuple[float, ...] | np.ndarray) -> str:
    return " ".join(f"{value:.6g}" for value in values)
