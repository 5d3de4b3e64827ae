"""The humanoid's shapes as markers, for RViz and Foxglove."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from unicon import rotations
from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.mjcf import Appearance
from unicon.humanoid.table import BODIES, ShapeSpec
from unicon.state import CharacterState
from unicon_ros.conversion import WORLD_FRAME, to_stamp, to_vector


@dataclass(frozen=True)
class _Part:
    """One marker in its body's frame."""

    body: int
    kind: int
    pos_b: np.ndarray
    quat_b: np.ndarray
    size: np.ndarray


def _parts_of(body: int, shape: ShapeSpec) -> list[_Part]:
    start, end = np.array(shape.start), np.array(shape.end)
    upright = np.array([1.0, 0.0, 0.0, 0.0])
    if shape.kind != "capsule":
        kind = Marker.CUBE if shape.kind == "box" else Marker.SPHERE
        return [_Part(body, kind, start, upright, 2 * end)]
    length, width = float(np.linalg.norm(end - start)), 2 * shape.radius
    ball = np.full(3, width)
    tube = _Part(
        body,
        Marker.CYLINDER,
        (start + end) / 2,
        _turn_z_to(end - start),
        np.array([width, width, length]),
    )
    return [tube, *(_Part(body, Marker.SPHERE, p, upright, ball) for p in (start, end))]


def _turn_z_to(direction: np.ndarray) -> np.ndarray:
    """Return the shortest turn ``(4,)`` from the z axis to ``direction``."""
    z = direction / np.linalg.norm(direction)
    if z[2] < -1 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    return rotations.normalize(np.array([1 + z[2], -z[1], z[0], 0.0]))


class HumanoidMarkers:
    """Builds the markers once and then only moves them."""

    def __init__(self, appearance: Appearance = Appearance()) -> None:  # noqa: B008 - frozen
        self._array = MarkerArray()
        self._parts: list[_Part] = []
        for index, body in enumerate(BODIES):
            for shape in body.shapes:
                colour = ColorRGBA(**dict(zip("rgba", appearance.colour_of(body, shape), strict=True)))
                for part in _parts_of(index, shape):
                    self._add(part, colour)
        self._bodies = [part.body for part in self._parts]
        self._pos_b = np.array([part.pos_b for part in self._parts])
        self._quat_b = np.array([part.quat_b for part in self._parts])

    def _add(self, part: _Part, colour: ColorRGBA) -> None:
        marker = Marker(ns="avatar", id=len(self._parts), type=part.kind, action=Marker.ADD, color=colour)
        marker.header.frame_id = WORLD_FRAME
        marker.scale = to_vector(part.size)
        self._array.markers.append(marker)
        self._parts.append(part)

    def place(self, state: CharacterState, time_ns: int) -> MarkerArray:
        """Return the markers of a state; the same message is used each time."""
        bodies = forward_kinematics(state)
        quat_w = bodies.quat_w[self._bodies]
        pos_w = bodies.pos_w[self._bodies] + rotations.rotate(quat_w, self._pos_b)
        quat_w = rotations.multiply(quat_w, self._quat_b)
        stamp = to_stamp(time_ns)
        for marker, pos, quat in zip(self._array.markers, pos_w.tolist(), quat_w.tolist(), strict=True):
            marker.header.stamp = stamp
            p, q = marker.pose.position, marker.pose.orientation
            p.x, p.y, p.z = pos
            q.w, q.x, q.y, q.z = quat
        return self._array
