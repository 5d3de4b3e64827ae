"""The humanoid as a MuJoCo model, written from the table.

Physics: 240 Hz, implicit integration of the joint damping, friction 1. Every solid shape touches the
floor and projectiles; the body's own parts pass through each other, since retargeted motion makes thighs
and arms graze and the contacts would only disturb (and cost a third of the speed). Warm starting is
off, so that positions and velocities alone determine the next state, to the bit.

Each hinge has two actuators in two groups, of which one group is enabled at a time: a motor, and a servo
with force = stiffness (control - angle), both limited by the effort factor.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco

from unicon.humanoid.table import BODIES, HINGES, BodySpec, HingeSpec, ShapeSpec

TIMESTEP_S = 1.0 / 240.0
FRICTION = 1.0
MOTOR_GROUP, SERVO_GROUP = 0, 1

Colour = tuple[float, float, float, float]


@dataclass(frozen=True)
class Appearance:
    """Colours (red, green, blue, opacity, each 0 to 1) of a humanoid."""

    skin: Colour = (0.93, 0.72, 0.30, 1.0)
    cloth: Colour = (0.90, 0.62, 0.16, 1.0)
    dark: Colour = (0.45, 0.32, 0.14, 1.0)
    left: Colour | None = None
    """Where set, everything on the left has this colour: a debug view."""
    right: Colour | None = None
    """Where set, everything on the right has this colour."""

    def colour_of(self, body: BodySpec, shape: ShapeSpec) -> Colour:
        """Return the colour of one shape."""
        side = {"left": self.left, "right": self.right}.get(body.name.split("_")[0])
        return side if side is not None else getattr(self, shape.tint)


def build_body(appearance: Appearance = Appearance(), prefix: str = "") -> str:  # noqa: B008 - frozen
    """Return the ``<body>`` element of the whole humanoid; ``prefix`` goes before every name."""
    return "\n".join(_body_lines(BODIES[0], appearance, prefix))


def build_mjcf(balls: int = 0) -> str:
    """Return the physics model: floor, humanoid, actuators and ``balls`` spheres to throw.

    The spheres are parked out of reach; `unicon.projectile` gives them mass, size and speed.
    """
    return f"""<mujoco model="unicon_humanoid">
<compiler angle="radian" autolimits="true"/>
<option timestep="{TIMESTEP_S!r}" integrator="implicitfast" solver="Newton" iterations="20">
<flag warmstart="disable" autoreset="disable"/>
</option>
<default><geom friction="{FRICTION} 0.005 0.0001" condim="3" solref="0.015 1"/></default>
<worldbody>
<geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="0"/>
{build_body()}
{"".join(_ball(i) for i in range(balls))}
</worldbody>
<actuator>
{"".join(_motor(h) for h in HINGES)}
{"".join(_servo(h) for h in HINGES)}
</actuator>
</mujoco>"""


def compile_model(balls: int = 0) -> mujoco.MjModel:
    """Return the compiled physics model; motors enabled, servos disabled."""
    model = mujoco.MjModel.from_xml_string(build_mjcf(balls))
    model.opt.disableactuator = 1 << SERVO_GROUP
    return model


def _body_lines(body: BodySpec, appearance: Appearance, prefix: str) -> Iterator[str]:
    yield f'<body name="{prefix}{body.name}" pos="{_numbers(body.offset)}">'
    if body.parent is None:
        yield f'<freejoint name="{prefix}root"/>'
    for hinge in body.hinges:
        yield _joint(hinge, prefix)
    solid_volume = sum(_volume(shape) for shape in body.shapes if shape.solid)
    for index, shape in enumerate(body.shapes):
        share = _volume(shape) / solid_volume if shape.solid else 0.0
        colour = appearance.colour_of(body, shape)
        yield _geom(shape, f"{prefix}{body.name}_{index}", body.mass * share, colour)
    for child in BODIES:
        if child.parent == body.name:
            yield from _body_lines(child, appearance, prefix)
    yield "</body>"


def _joint(hinge: HingeSpec, prefix: str) -> str:
    return (
        f'<joint name="{prefix}{hinge.name}" type="hinge" axis="{_numbers(hinge.axis)}" '
        f'range="{hinge.lower_rad!r} {hinge.upper_rad!r}" damping="{hinge.damping}" '
        f'armature="{hinge.armature}"/>'
    )


def _geom(shape: ShapeSpec, name: str, mass: float, colour: Colour) -> str:
    if shape.kind == "capsule":
        form = f'fromto="{_numbers(shape.start)} {_numbers(shape.end)}" size="{shape.radius}"'
    else:
        form = f'pos="{_numbers(shape.start)}" size="{_numbers(shape.end)}"'
    contact = 'contype="0" conaffinity="1"' if shape.solid else 'contype="0" conaffinity="0" group="1"'
    return (
        f'<geom name="{name}" type="{shape.kind}" {form} mass="{mass!r}" {contact} '
        f'rgba="{_numbers(colour)}"/>'
    )


def _volume(shape: ShapeSpec) -> float:
    """Return the volume [m^3] over pi, but for boxes the true one over pi as well."""
    if shape.kind == "capsule":
        length = sum((a - b) ** 2 for a, b in zip(shape.start, shape.end, strict=True)) ** 0.5
        return shape.radius**2 * (length + 4.0 / 3.0 * shape.radius)
    a, b, c = shape.end
    return 4.0 / 3.0 * a * b * c if shape.kind == "ellipsoid" else 8.0 * a * b * c / 3.141592653589793


def _motor(hinge: HingeSpec) -> str:
    return (
        f'<motor name="{hinge.name}_motor" joint="{hinge.name}" group="{MOTOR_GROUP}" gear="1" '
        f'ctrlrange="{-hinge.effort} {hinge.effort}"/>\n'
    )


def _servo(hinge: HingeSpec) -> str:
    k = hinge.stiffness
    return (
        f'<general name="{hinge.name}_servo" joint="{hinge.name}" group="{SERVO_GROUP}" gear="1" '
        f'biastype="affine" gainprm="{k}" biasprm="0 {-k} 0" '
        f'forcerange="{-hinge.effort} {hinge.effort}"/>\n'
    )


def _ball(index: int) -> str:
    return (
        f'<body name="ball{index}" pos="{100 + 2 * index} 100 1"><freejoint name="ball{index}"/>'
        f'<geom name="ball{index}" type="sphere" size="0.1" mass="1" contype="0" conaffinity="0" '
        f'rgba="0.75 0.2 0.15 1"/></body>\n'
    )


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:.9g}" for value in values)
