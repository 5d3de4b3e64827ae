"""Reads Acclaim's two files: .asf, a skeleton, and .amc, the angles of its bones over time.

A bone of the .asf has a direction and a length in the world, at rest, and an axis frame C: three angles about
the world's axes. The .amc gives each bone turns about the axes of that frame, M, so that against its parent

    L = C M C^-1,    C = R_z R_y R_x,    M = R_z R_y R_x

for ``axis XYZ`` and ``dof rx ry rz``: what stands first turns first, about axes that stay. At rest M and so L
are the identity. A joint here is where its bone begins, and bears the bone's name; so its offset in the
parent's frame is direction times length of the parent's bone, and the ends of the last bones are left out.
The root's translation is its place in the world. Lengths stay in the file's unit; y is up.

(Lander, "Working with Motion Capture File Formats", Game Developer, January 1998.)
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.line_numbers import LineNumbers
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

RATE_HZ = 120.0
"""The format has no rate; this is the one of nearly all such files that there are (CMU, HDM05)."""
SLOW_CMU_SUBJECTS = (33, 34, 42, 60, 61, 62, 74, 75, 77, 79, 80, 87, 88, 89)
SLOW_CMU_RATE_HZ = 60.0
"""CMU captured these subjects at this rate, as its index says; its files don't."""
SLOW_CMU_SESSIONS = ("acrobatwednesday",)
"""Of these subjects (88), as the first line of an .amc names them; so a take of another name is known too."""

_AXES = {"x": (0.0, 1.0, 0.0), "y": (0.0, 0.0, 1.0), "z": (1.0, 0.0, 0.0)}
"""Acclaim's axes (x left, y up, z forward) in ours (x forward, y left, z up)."""


@dataclass
class _Bone:
    name: str
    parent: str = ""
    vector: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """From its beginning to its end at rest, in the file's axes."""
    axis: np.ndarray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0, 0.0]))
    """C, in our axes."""
    channels: tuple[str, ...] = ()


_Block = dict[str, tuple[int, list[str]]]
"""A bone's keys, each with its line and the words behind it."""


class _Lines(LineNumbers):
    """The lines of a file that say something, with their numbers for error messages."""

    def __init__(self, file: MotionFile) -> None:
        super().__init__(file.origin)
        lines = file.read().decode("latin-1").splitlines()
        self.first = lines[0] if lines else ""
        pairs = ((number, line.split("#", 1)[0].split()) for number, line in enumerate(lines, 1))
        self._lines: Iterator[tuple[int, list[str]]] = (pair for pair in pairs if pair[1])

    def __iter__(self) -> Iterator[list[str]]:
        for number, words in self._lines:
            self.number = number
            yield words


def read_amc(file: MotionFile) -> SourceMotion:
    """Read a motion and, from the same folder, its skeleton; lengths stay in the file's unit.

    Raises:
        InputFileError: when one of the two is missing or not whole; the message names file and line.
    """
    skeleton = file.sibling("*.asf")
    if skeleton is None:
        raise InputFileError(
            f"{file.origin}: has no skeleton; expected one .asf beside it, or one named as the take begins"
        )
    bones = _read_skeleton(_Lines(skeleton))
    lines = _Lines(file)
    values = _read_frames(lines, bones)
    names = [bone.name for bone in bones]
    ends = {bone.name: bone.vector for bone in bones} | {"": np.zeros(3)}
    root = values["root"]
    place = np.stack([root[:, bones[0].channels.index(f"t{axis}")] for axis in "xyz"], axis=-1)
    return SourceMotion(
        name=file.name,
        family="",
        joint_names=tuple(names),
        parents=np.array([names.index(bone.parent) if bone.parent else -1 for bone in bones]),
        offsets=_to_z_up(np.array([ends[bone.parent] for bone in bones])),
        times_s=np.arange(len(root)) / rate_hz(file.name, lines.first),
        root_pos=_to_z_up(place),
        local_quat=np.stack([_rotation(bone, values, len(root)) for bone in bones], axis=1),
    )


def rate_hz(name: str, first_line: str = "") -> float:
    """Return the rate [Hz] of a take.

    Args:
        name: begins with CMU's subject: 60_08 is of subject 60.
        first_line: the .amc's first line, in which CMU's files name the session.
    """
    match = re.match(r"0*(\d{1,3})_\d+", name)
    slow = match is not None and int(match[1]) in SLOW_CMU_SUBJECTS
    session = any(name in first_line for name in SLOW_CMU_SESSIONS)
    return SLOW_CMU_RATE_HZ if slow or session else RATE_HZ


def _read_skeleton(lines: _Lines) -> list[_Bone]:
    """Return the bones, the root first and parents before children."""
    bones = {"root": _Bone("root")}
    scale, section = 1.0, ""
    block: _Block = {}
    children: list[tuple[str, str]] = []
    for words in lines:
        if words[0].startswith(":"):
            section, block = words[0].lower(), {}
        elif section == ":units" and words[0] == "angle":
            scale = _angle_unit(lines, words)
        elif section == ":root":
            _read_root(lines, words, bones["root"], block, scale)
        elif section == ":bonedata" and words[0] == "end":
            bone = _make_bone(lines, block, scale)
            bones[bone.name] = bone
        elif section == ":bonedata":
            block = {} if words[0] == "begin" else {**block, words[0]: (lines.number, words[1:])}
        elif section == ":hierarchy" and words[0] not in ("begin", "end"):
            children += [(words[0], child) for child in words[1:]]
            _check_known(lines, words, bones)
    return _in_order(lines, bones, children)


def _angle_unit(lines: _Lines, words: list[str]) -> float:
    units = {"deg": np.radians(1.0), "rad": 1.0}
    if len(words) != 2 or words[1] not in units:
        raise lines.fail(f"angle is {' '.join(words[1:])!r}, expected 'deg' or 'rad'")
    return units[words[1]]


def _read_root(lines: _Lines, words: list[str], root: _Bone, block: _Block, scale: float) -> None:
    block[words[0]] = (lines.number, words[1:])
    if words[0] == "order":
        root.channels = tuple(word.lower() for word in words[1:])
        if sorted(root.channels) != ["rx", "ry", "rz", "tx", "ty", "tz"]:
            raise lines.fail(f"order is {' '.join(words[1:])!r}, expected TX TY TZ RX RY RZ in some order")
    if {"axis", "orientation"} <= block.keys():
        angles = lines.numbers(_take(lines, block, "orientation"), 3, "orientation")
        root.axis = _axis_frame(lines, angles, _take(lines, block, "axis"), scale)


def _make_bone(lines: _Lines, block: _Block, scale: float) -> _Bone:
    missing = [key for key in ("name", "direction", "length", "axis") if key not in block]
    if missing:
        raise lines.fail(f"a bone without {missing[0]}")
    name = " ".join(_take(lines, block, "name"))
    direction = lines.numbers(_take(lines, block, "direction"), 3, f"direction of {name}")
    (length,) = lines.numbers(_take(lines, block, "length"), 1, f"length of {name}")
    channels = tuple(word.lower() for word in _take(lines, block, "dof")) if "dof" in block else ()
    if set(channels) - {"rx", "ry", "rz"} or len(set(channels)) < len(channels):
        raise lines.fail(f"dof of {name} is {' '.join(channels)!r}, expected some of rx ry rz")
    axis = _take(lines, block, "axis")
    frame = _axis_frame(lines, lines.numbers(axis[:3], 3, f"axis of {name}"), axis[3:], scale)
    return _Bone(name, "", length * np.array(direction), frame, channels)


def _take(lines: _Lines, block: _Block, key: str) -> list[str]:
    """Return what a block says of a key, and go to its line, so that an error names that."""
    lines.number, words = block[key]
    return words


def _axis_frame(lines: _Lines, angles: list[float], order: list[str], scale: float) -> np.ndarray:
    letters = "".join(order).lower()
    if sorted(letters) != ["x", "y", "z"]:
        raise lines.fail(f"axis order is {letters!r}, expected XYZ or another order of these")
    return _turn(letters, scale * np.array(angles))


def _check_known(lines: _Lines, words: list[str], bones: dict[str, _Bone]) -> None:
    for word in words:
        if word not in bones:
            raise lines.fail(f"the hierarchy names {word!r}, which is no bone of the skeleton")


def _in_order(lines: _Lines, bones: dict[str, _Bone], children: list[tuple[str, str]]) -> list[_Bone]:
    if not bones["root"].channels or not children:
        raise lines.fail("the skeleton has no ':root' with an order, or no ':hierarchy'; expected both")
    ordered = [bones["root"]]
    for bone in ordered:
        for child in [bones[child] for parent, child in children if parent == bone.name]:
            if child in ordered:
                raise lines.fail(f"the hierarchy names {child.name!r} twice")
            child.parent = bone.name
            ordered.append(child)
    return ordered


def _read_frames(lines: _Lines, bones: list[_Bone]) -> dict[str, np.ndarray]:
    """Return the channels ``(T, n)`` of each bone that has some; angles in radians."""
    sizes = {bone.name: len(bone.channels) for bone in bones if bone.channels}
    rows: dict[str, list[list[float]]] = {name: [] for name in sizes}
    scale, count, first = np.radians(1.0), 0, None
    for words in lines:
        if words[0].startswith(":"):
            scale = 1.0 if words[0].upper() == ":RADIANS" else scale
        elif len(words) == 1 and words[0].isdecimal():
            _check_whole(lines, rows, count)
            first = int(words[0]) if first is None else first
            if int(words[0]) != first + count:
                raise lines.fail(
                    f"frame {words[0]} where frame {first + count} was expected; frames are missing"
                )
            count += 1
        elif words[0] not in sizes or len(rows[words[0]]) != count - 1:
            raise lines.fail(f"did not expect {words[0]!r} in frame {count}: no bone that moves, or twice")
        else:
            rows[words[0]].append(lines.numbers(words[1:], sizes[words[0]], words[0]))
    _check_whole(lines, rows, count)
    if count < 2:
        raise lines.fail(f"ends with {count} frames, expected 2 or more")
    return {
        bone.name: np.array(rows[bone.name]) * [scale if name[0] == "r" else 1.0 for name in bone.channels]
        for bone in bones
        if bone.channels
    }


def _check_whole(lines: _Lines, rows: dict[str, list[list[float]]], count: int) -> None:
    missing = [name for name, values in rows.items() if len(values) != count]
    if missing:
        raise lines.fail(f"frame {count} has no {missing[0]!r}; the file is cut short or of another skeleton")


def _rotation(bone: _Bone, values: dict[str, np.ndarray], frames: int) -> np.ndarray:
    """Return L ``(T, 4)`` of a bone."""
    turning = [column for column, channel in enumerate(bone.channels) if channel[0] == "r"]
    if not turning:
        return np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    own = _turn("".join(bone.channels[column][1] for column in turning), values[bone.name][:, turning])
    return rotations.multiply(rotations.multiply(bone.axis, own), rotations.conjugate(bone.axis))


def _turn(order: str, angles: np.ndarray) -> np.ndarray:
    """Return the rotation ``(..., 4)`` by angles ``(..., n)`` about fixed axes, the first one first."""
    turn = rotations.from_axis_angle(np.array(_AXES[order[0]]), angles[..., 0])
    for place in range(1, len(order)):
        later = rotations.from_axis_angle(np.array(_AXES[order[place]]), angles[..., place])
        turn = rotations.multiply(later, turn)
    return turn


def _to_z_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x left, y up, z forward into x forward, y left, z up."""
    return vectors[..., [2, 0, 1]]
