"""Reads BVH, the animators' format: a tree of joints with offsets and channels, then rows of numbers.

Any skeleton and any order of channels. BVH has y up and no unit of length. A joint's position channels stand
in the place of its OFFSET, as writers of this format mean it, and its rotation channels are turns about its
own axes in their order: with the channels Z, X, Y a joint's rotation is R_z R_x R_y.

Accepted, since nothing is lost: keywords in small letters, braces on the line of a joint, tabs, blank
lines, all ends of lines, ``Frames`` and ``Frame Time`` with or without colon, rows beyond the promised number
(left out, also when they are cut short). Refused: missing rows, rows with too few or too many numbers, a
second ROOT.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.line_numbers import LineNumbers
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

MOVES_SHARE = 0.001
"""How far a joint must move in its parent's frame, against the skeleton's extent, to be more than rounded."""

_AXES = {"X": (0.0, 1.0, 0.0), "Y": (0.0, 0.0, 1.0), "Z": (1.0, 0.0, 0.0)}
"""BVH's axes (x left, y up, z forward) in ours (x forward, y left, z up)."""
_CHANNELS = {f"{axis}{kind}".lower(): f"{axis}{kind}" for axis in "XYZ" for kind in ("position", "rotation")}


@dataclass
class _Joint:
    name: str
    parent: int
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[str] = field(default_factory=list)
    first_column: int = 0

    def columns(self, kind: str) -> dict[str, int]:
        """Return the column of each axis, in the channels' order."""
        wanted = enumerate(self.channels, self.first_column)
        return {channel[0]: column for column, channel in wanted if channel.endswith(kind)}


class _Reader(LineNumbers):
    """The lines of a file, with their numbers for error messages."""

    def __init__(self, file: MotionFile) -> None:
        super().__init__(file.origin)
        self._lines = file.read().removeprefix(b"\xef\xbb\xbf").splitlines()
        while self._lines and not self._lines[-1].strip():
            self._lines.pop()
        if not self._lines:
            raise InputFileError(f"{self.origin}: is empty, expected BVH text")
        self._waiting: list[str] = []

    def next(self, expected: str) -> list[str]:
        """Return the words of the next statement: a brace, or a line up to a brace."""
        while not self._waiting:
            if self.number == len(self._lines):
                end = f"{self.origin}: ends after line {self.number}"
                raise InputFileError(f"{end}, expected {expected}; the file is cut short")
            self.number += 1
            self._waiting = re.findall(r"[{}]|[^{}\s][^{}]*", self._decode(self._lines[self.number - 1]))
        return self._waiting.pop(0).split()

    def rows(self) -> list[bytes]:
        """Return the remaining lines that are not blank."""
        return [line for line in self._lines[self.number :] if line.strip()]

    def _decode(self, line: bytes) -> str:
        try:
            return line.decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputFileError(f"{self.origin}: is binary, expected BVH text") from error


def read_bvh(file: MotionFile) -> SourceMotion:
    """Read a motion; lengths stay in the file's unit.

    Where joints other than the root have position channels that really move, the motion has ``local_pos``;
    where they merely repeat one place, this is the joint's offset.

    Raises:
        InputFileError: when the file is not whole BVH; the message names the line.
    """
    reader = _Reader(file)
    joints = _read_hierarchy(reader)
    rate_hz, values = _read_frames(reader, sum(len(joint.channels) for joint in joints))
    offsets = np.array([joint.offset for joint in joints])
    root_pos = _places(joints[0], values)
    offsets[0] = 0.0
    motion = SourceMotion(
        name=file.name,
        family="",
        joint_names=tuple(joint.name for joint in joints),
        parents=np.array([joint.parent for joint in joints]),
        offsets=_to_z_up(offsets),
        times_s=np.arange(len(values)) / rate_hz,
        root_pos=_to_z_up(root_pos),
        local_quat=_rotations(joints, values),
    )
    return _with_moving_joints(motion, joints, values)


def _read_hierarchy(reader: _Reader) -> list[_Joint]:
    if [word.upper() for word in reader.next("HIERARCHY")] != ["HIERARCHY"]:
        raise reader.fail("expected HIERARCHY; this is not BVH")
    joints: list[_Joint] = []
    open_joints: list[int] = []
    while True:
        words = reader.next("the skeleton's end and MOTION")
        match [words[0].upper(), *words[1:]]:
            case ["ROOT", *_] if joints:
                raise reader.fail("a second ROOT; expected one skeleton a file, so split the file")
            case ["ROOT" | "JOINT", *name] if name and bool(joints) == bool(open_joints):
                joints.append(_Joint(" ".join(name), open_joints[-1] if open_joints else -1))
                open_joints.append(len(joints) - 1)
            case ["END", *_] if open_joints:
                open_joints.append(-1)
            case ["{"]:
                pass
            case ["OFFSET", *numbers] if open_joints:
                offset = reader.numbers(numbers, 3, "OFFSET")
                if open_joints[-1] >= 0:
                    joints[open_joints[-1]].offset = offset
            case ["CHANNELS", count, *channels] if _may_have_channels(joints, open_joints):
                joint = joints[open_joints[-1]]
                joint.first_column = sum(len(other.channels) for other in joints)
                joint.channels = _channels(reader, count, channels)
            case ["}"] if open_joints:
                open_joints.pop()
            case ["MOTION"] if joints and not open_joints:
                return joints
            case _:
                raise reader.fail(f"did not expect {' '.join(words)[:40]!r} in the skeleton")


def _may_have_channels(joints: list[_Joint], open_joints: list[int]) -> bool:
    return bool(open_joints) and open_joints[-1] >= 0 and not joints[open_joints[-1]].channels


def _channels(reader: _Reader, count: str, words: list[str]) -> list[str]:
    channels = [_CHANNELS.get(word.lower(), "") for word in words]
    if count != str(len(channels)) or "" in channels or len(set(channels)) < len(channels):
        raise reader.fail(f"CHANNELS {count} does not fit {' '.join(words)!r}")
    return channels


def _read_frames(reader: _Reader, channels: int) -> tuple[float, np.ndarray]:
    """Return the rate [Hz] and the numbers ``(T, channels)``."""
    count_text = _value(reader, "Frames:", r"frames\s*:?\s*(\S+)", "Frames: N")
    if not count_text.isdecimal():
        raise reader.fail("expected 'Frames: N'")
    count = int(count_text)
    period_text = _value(reader, "Frame Time:", r"frame\s*time\s*:?\s*(\S+)", "Frame Time: seconds")
    (period_s,) = reader.numbers([period_text], 1, "Frame Time")
    if count < 2 or not period_s > 0:
        raise reader.fail(f"{count} frames of {period_s} s are no motion")
    if channels == 0:
        raise reader.fail("the skeleton has no channels, so nothing moves")
    return 1.0 / period_s, _read_rows(reader, count, channels)


def _value(reader: _Reader, what: str, pattern: str, form: str) -> str:
    match = re.fullmatch(pattern, " ".join(reader.next(what)), re.IGNORECASE)
    if match is None:
        raise reader.fail(f"expected {form!r}")
    return match[1]


def _read_rows(reader: _Reader, count: int, channels: int) -> np.ndarray:
    """Parse all rows at once; only where that fails, look for the line that is wrong."""
    rows = reader.rows()[:count]
    reason = ""
    if len(rows) == count:
        try:
            values = np.loadtxt(rows, comments=None, ndmin=2, encoding="latin-1")
        except ValueError as error:
            reason = str(error)
        else:
            if values.shape == (count, channels) and np.isfinite(values).all():
                return values
    for number in range(1, count + 1):
        reader.numbers(reader.next(f"frame {number} of {count}"), channels, f"frame {number}")
    raise reader.fail(f"up to here the frames cannot be read ({reason})")


def _rotations(joints: list[_Joint], values: np.ndarray) -> np.ndarray:
    """Return local rotations ``(T, J, 4)`` in our axes: joints with the same order of channels at once."""
    turns = np.zeros((len(values), len(joints), 4))
    turns[..., 0] = 1.0
    orders: dict[str, list[int]] = {}
    for index, joint in enumerate(joints):
        orders.setdefault("".join(joint.columns("rotation")), []).append(index)
    for order, members in orders.items():
        for place, axis in enumerate(order):
            columns = [joints[index].columns("rotation")[axis] for index in members]
            turn = rotations.from_axis_angle(np.array(_AXES[axis]), np.radians(values[:, columns]))
            turns[:, members] = rotations.multiply(turns[:, members], turn) if place else turn
    return turns


def _places(joint: _Joint, values: np.ndarray) -> np.ndarray:
    """Return where a joint is in its parent's frame ``(T, 3)``, in the file's axes."""
    places = np.tile(joint.offset, (len(values), 1))
    for axis, column in joint.columns("position").items():
        places[:, "XYZ".index(axis)] = values[:, column]
    return places


def _with_moving_joints(motion: SourceMotion, joints: list[_Joint], values: np.ndarray) -> SourceMotion:
    """Return the motion with the places of all joints that have position channels besides the root."""
    tolerance = MOVES_SHARE * float(np.ptp(motion.rest_positions(), axis=0).max())
    offsets, moving = motion.offsets.copy(), {}
    for index, joint in enumerate(joints):
        if index == 0 or not joint.columns("position"):
            continue
        places = _to_z_up(_places(joint, values))
        if np.ptp(places, axis=0).max() > 2.0 * tolerance:
            moving[index] = places
        elif np.any(places) and np.abs(places.mean(axis=0) - offsets[index]).max() > tolerance:
            offsets[index] = places.mean(
                axis=0
            )  # all zeros mean no change of OFFSET, not a bone of no length
    if not moving:
        return replace(motion, offsets=offsets)
    local_pos = np.tile(offsets, (len(values), 1, 1))
    local_pos[:, 0] = motion.root_pos
    for index, places in moving.items():
        local_pos[:, index] = places
    return replace(motion, offsets=offsets, local_pos=local_pos)


def _to_z_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x left, y up, z forward into x forward, y left, z up."""
    return vectors[..., [2, 0, 1]]
