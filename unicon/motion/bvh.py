"""Reads BVH, the animators' format: a tree of joints with offsets and channels, then rows of numbers.

Any skeleton and any order of channels. BVH has y up and no unit of length; the mapping of a skeleton family
says how long a unit is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.source_motion import SourceMotion

_AXES = {"X": (0.0, 1.0, 0.0), "Y": (0.0, 0.0, 1.0), "Z": (1.0, 0.0, 0.0)}
"""BVH's axes (x left, y up, z forward) in ours (x forward, y left, z up)."""
_KINDS = {f"{axis}{kind}" for axis in "XYZ" for kind in ("position", "rotation")}


@dataclass
class _Joint:
    name: str
    parent: int
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[str] = field(default_factory=list)


class _Reader:
    """The lines of a file, with their numbers for error messages."""

    def __init__(self, path: Path, lines: list[str]) -> None:
        self.path, self.number = path, 0
        self._lines: Iterator[tuple[int, str]] = iter(
            [(n, line.strip()) for n, line in enumerate(lines, 1) if line.strip()]
        )

    def next(self, expected: str) -> list[str]:
        """Return the words of the next line that is not empty."""
        try:
            self.number, line = next(self._lines)
        except StopIteration:
            raise InputFileError(
                f"{self.path}: ends after line {self.number}, expected {expected}; the file is cut short"
            ) from None
        return line.split()

    def fail(self, problem: str) -> InputFileError:
        """Return an error at the present line."""
        return InputFileError(f"{self.path}, line {self.number}: {problem}")

    def numbers(self, words: list[str], count: int, what: str) -> list[float]:
        """Return ``count`` finite numbers.

        Raises:
            InputFileError: when the words are others.
        """
        if len(words) != count:
            raise self.fail(f"{what} has {len(words)} numbers, expected {count}")
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise self.fail(f"{what} holds something that is not a number") from None
        if not np.isfinite(values).all():
            raise self.fail(f"{what} holds a number that is not finite")
        return values


def read_bvh(path: Path, family: str, unit_m: float) -> SourceMotion:
    """Read a motion whose unit of length is ``unit_m``.

    Raises:
        InputFileError: when the file is not whole BVH; the message names the line.
    """
    reader = _Reader(path, _read_lines(path))
    joints = _read_hierarchy(reader)
    rate_hz, values = _read_frames(reader, sum(len(joint.channels) for joint in joints))
    offsets = np.array([joint.offset for joint in joints])
    root_pos, turns = _apply_channels(joints, values, offsets)
    offsets[0] = 0.0
    return SourceMotion(
        name=path.stem,
        family=family,
        joint_names=tuple(joint.name for joint in joints),
        parents=np.array([joint.parent for joint in joints]),
        offsets=_to_z_up(offsets) * unit_m,
        times_s=np.arange(len(values)) / rate_hz,
        root_pos=_to_z_up(root_pos) * unit_m,
        local_quat=turns,
    )


def _read_lines(path: Path) -> list[str]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputFileError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputFileError(f"{path}: is binary, expected BVH text") from error
    if not text.strip():
        raise InputFileError(f"{path}: is empty, expected BVH text")
    return text.splitlines()


def _read_hierarchy(reader: _Reader) -> list[_Joint]:
    if reader.next("HIERARCHY") != ["HIERARCHY"]:
        raise reader.fail("expected HIERARCHY; this is not BVH")
    joints: list[_Joint] = []
    open_joints: list[int] = []
    while True:
        words = reader.next("the skeleton's end and MOTION")
        match words:
            case ["ROOT" | "JOINT", *name]:
                joints.append(_Joint(" ".join(name), open_joints[-1] if open_joints else -1))
                open_joints.append(len(joints) - 1)
            case ["End", *_]:
                open_joints.append(-1)
            case ["{"]:
                pass
            case ["OFFSET", *numbers]:
                offset = reader.numbers(numbers, 3, "OFFSET")
                if open_joints and open_joints[-1] >= 0:
                    joints[open_joints[-1]].offset = offset
            case ["CHANNELS", count, *channels]:
                if not open_joints or count != str(len(channels)) or set(channels) - _KINDS:
                    raise reader.fail(f"CHANNELS {count} does not fit {' '.join(channels)!r}")
                joints[open_joints[-1]].channels = channels
            case ["}"] if open_joints:
                open_joints.pop()
            case ["MOTION"] if joints and not open_joints:
                return joints
            case _:
                raise reader.fail(f"did not expect {' '.join(words)[:40]!r} in the skeleton")


def _read_frames(reader: _Reader, channels: int) -> tuple[float, np.ndarray]:
    words = reader.next("Frames:")
    if len(words) != 2 or words[0] != "Frames:" or not words[1].isdigit():
        raise reader.fail("expected 'Frames: N'")
    count = int(words[1])
    words = reader.next("Frame Time:")
    if words[:2] != ["Frame", "Time:"]:
        raise reader.fail("expected 'Frame Time: seconds'")
    (period_s,) = reader.numbers(words[2:], 1, "Frame Time")
    if count < 2 or not period_s > 0:
        raise reader.fail(f"{count} frames of {period_s} s are no motion")
    rows = [
        reader.numbers(reader.next(f"frame {n + 1} of {count}"), channels, f"frame {n + 1}")
        for n in range(count)
    ]
    return 1.0 / period_s, np.array(rows)


def _apply_channels(
    joints: list[_Joint], values: np.ndarray, offsets: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the root's position ``(T, 3)`` in the file's axes, and local rotations ``(T, J, 4)`` in ours."""
    root_pos = np.tile(offsets[0], (len(values), 1))
    turns = np.zeros((len(values), len(joints), 4))
    turns[..., 0] = 1.0
    column = 0
    for index, joint in enumerate(joints):
        for channel in joint.channels:
            if channel.endswith("rotation"):
                turn = rotations.from_axis_angle(np.array(_AXES[channel[0]]), np.radians(values[:, column]))
                turns[:, index] = rotations.multiply(turns[:, index], turn)
            elif index == 0:
                root_pos[:, "XYZ".index(channel[0])] = values[:, column]
            column += 1
    return root_pos, turns


def _to_z_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x left, y up, z forward into x forward, y left, z up."""
    return vectors[..., [2, 0, 1]]
