"""Skeletons and motions for tests of BVH: written as text, and where their joints are by plain matrices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation


@dataclass(frozen=True)
class Joint:
    parent: int
    offset: tuple[float, float, float]
    channels: tuple[str, ...]


@dataclass(frozen=True)
class Motion:
    joints: tuple[Joint, ...]
    values: np.ndarray
    rate_hz: float = 30.0


def write(motion: Motion, newline: str = "\n", indent: str = "  ") -> str:
    """Return the motion as BVH."""
    lines = ["HIERARCHY", *_write_joint(motion, 0, 0, indent), "MOTION", f"Frames: {len(motion.values)}"]
    lines.append(f"Frame Time: {1.0 / motion.rate_hz!r}")
    lines += [" ".join(repr(float(value)) for value in row) for row in motion.values]
    return newline.join(lines) + newline


def _write_joint(motion: Motion, index: int, depth: int, indent: str) -> list[str]:
    joint = motion.joints[index]
    pad, inside = depth * indent, (depth + 1) * indent
    lines = [f"{pad}{'JOINT' if depth else 'ROOT'} j{index}", pad + "{"]
    lines.append(f"{inside}OFFSET {' '.join(repr(value) for value in joint.offset)}")
    lines.append(f"{inside}CHANNELS {len(joint.channels)} {' '.join(joint.channels)}")
    children = [k for k, other in enumerate(motion.joints) if other.parent == index]
    for child in children:
        lines += _write_joint(motion, child, depth + 1, indent)
    if not children:
        lines += [inside + "End Site", inside + "{", inside + indent + "OFFSET 0.0 1.0 0.0", inside + "}"]
    return [*lines, pad + "}"]


def joint_positions(motion: Motion) -> np.ndarray:
    """Return where the joints are (T, J, 3) in the file's axes: one frame and joint after the other."""
    places = np.zeros((len(motion.values), len(motion.joints), 3))
    for frame, row in enumerate(motion.values):
        turns, column = [], 0
        for index, joint in enumerate(motion.joints):
            local, place = np.eye(3), np.array(joint.offset)
            for channel in joint.channels:
                if channel.endswith("position"):
                    place["XYZ".index(channel[0])] = row[column]
                else:
                    local = local @ Rotation.from_euler(channel[0], row[column], degrees=True).as_matrix()
                column += 1
            above = np.eye(3) if joint.parent < 0 else turns[joint.parent]
            base = np.zeros(3) if joint.parent < 0 else places[frame, joint.parent]
            places[frame, index] = base + above @ place
            turns.append(above @ local)
    return places


_LENGTHS = st.floats(-20, 20).map(lambda value: round(value, 3))
_NUMBERS = st.floats(0.5, 200.0) | st.floats(-200.0, -0.5)
"""Never zero: positions that are all zero mean OFFSET."""
_ROTATIONS = st.permutations(["Xrotation", "Yrotation", "Zrotation"])
_POSITIONS = st.permutations(["Xposition", "Yposition", "Zposition"])


@st.composite
def motions(draw) -> Motion:
    """Draw chains and trees; joints in the order in which BVH has them, some with position channels."""
    joints: list[Joint] = []
    branch = [-1]
    for _ in range(draw(st.integers(1, 6))):
        del branch[draw(st.integers(1, len(branch))) if joints else 1 :]
        if joints and len(branch) == 1:
            branch.append(0)
        channels = draw(_ROTATIONS)[: draw(st.integers(1, 3))]
        if not joints or draw(st.booleans()):
            channels = draw(st.permutations([*channels, *draw(_POSITIONS)]))
        joints.append(Joint(branch[-1], draw(st.tuples(_LENGTHS, _LENGTHS, _LENGTHS)), tuple(channels)))
        branch.append(len(joints) - 1)
    width = sum(len(joint.channels) for joint in joints)
    frames = draw(st.integers(2, 4))
    numbers = st.lists(_NUMBERS, min_size=frames * width, max_size=frames * width)
    return Motion(tuple(joints), np.array(draw(numbers)).reshape(frames, width))
