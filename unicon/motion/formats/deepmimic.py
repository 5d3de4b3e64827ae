"""Reads DeepMimic's motions: JSON with one row of 44 numbers a frame, on DeepMimic's own skeleton.

A row: duration [s], root position (3) [m], root rotation (4), chest (4), neck (4), right hip (4), right
knee (1) [rad], right ankle (4), right shoulder (4), right elbow (1), then the left leg and arm alike.
Quaternions are w, x, y, z, the y axis is up, x forward, and hinges turn about z.
"""

from __future__ import annotations

import json

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

ROW_SIZE = 44
MIN_QUAT_LENGTH = 0.5
"""Known files are up to a tenth off the unit length; a shorter quaternion is a defect."""

_SKELETON = (
    # name, parent, offset in DeepMimic's axes [m], columns of its rotation (one column: a hinge)
    ("root", -1, (0.0, 0.0, 0.0), (4, 8)),
    ("chest", 0, (0.0, 0.236151, 0.0), (8, 12)),
    ("neck", 1, (0.0, 0.223894, 0.0), (12, 16)),
    ("right_hip", 0, (0.0, 0.0, 0.084887), (16, 20)),
    ("right_knee", 3, (0.0, -0.421546, 0.0), (20, 21)),
    ("right_ankle", 4, (0.0, -0.409870, 0.0), (21, 25)),
    ("right_shoulder", 1, (-0.02405, 0.24350, 0.18311), (25, 29)),
    ("right_elbow", 6, (0.0, -0.274788, 0.0), (29, 30)),
    ("right_wrist", 7, (0.0, -0.258947, 0.0), (0, 0)),
    ("left_hip", 0, (0.0, 0.0, -0.084887), (30, 34)),
    ("left_knee", 9, (0.0, -0.421546, 0.0), (34, 35)),
    ("left_ankle", 10, (0.0, -0.409870, 0.0), (35, 39)),
    ("left_shoulder", 1, (-0.02405, 0.24350, -0.18311), (39, 43)),
    ("left_elbow", 12, (0.0, -0.274788, 0.0), (43, 44)),
    ("left_wrist", 13, (0.0, -0.258947, 0.0), (0, 0)),
)
_QUATERNIONS = [columns for *_, columns in _SKELETON if columns[1] - columns[0] == 4]


def read_deepmimic(file: MotionFile) -> SourceMotion:
    """Read a motion.

    Raises:
        InputFileError: when the file is not such a motion; the message names the frame.
    """
    rows, loop = _read_rows(file)
    return SourceMotion(
        name=file.name.removeprefix("humanoid3d_"),
        family="",
        joint_names=tuple(name for name, *_ in _SKELETON),
        parents=np.array([parent for _, parent, *_ in _SKELETON]),
        offsets=_to_z_up(np.array([offset for _, _, offset, _ in _SKELETON])),
        times_s=np.concatenate([[0.0], np.cumsum(rows[:-1, 0])]),
        root_pos=_to_z_up(rows[:, 1:4]),
        local_quat=np.stack([_rotation(rows, *columns) for *_, columns in _SKELETON], axis=1),
        loop=loop,
    )


def _read_rows(file: MotionFile) -> tuple[np.ndarray, bool]:
    try:
        content = json.loads(file.read().decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputFileError(f"{file.origin}: is binary, expected DeepMimic's JSON") from error
    except (ValueError, RecursionError) as error:
        raise InputFileError(f"{file.origin}: is not whole JSON ({error}); fetch the file again") from error
    frames = content.get("Frames") if isinstance(content, dict) else None
    if not isinstance(frames, list) or len(frames) < 2:
        raise InputFileError(f"{file.origin}: expected a list 'Frames' with 2 or more frames")
    try:
        rows = np.array(frames, dtype=float)
    except (ValueError, TypeError, OverflowError):
        rows = np.zeros((0, 0))
    if not _are_whole(rows):
        for number, frame in enumerate(frames, 1):
            _check_frame(file, number, frame, is_last=number == len(frames))
    return rows, content.get("Loop") == "wrap"


def _are_whole(rows: np.ndarray) -> bool:
    """Tell whether nothing is wrong with any frame, at once; what is wrong then takes longer to find."""
    if rows.ndim != 2 or rows.shape[1] != ROW_SIZE or not np.isfinite(rows).all():
        return False
    lengths = [np.linalg.norm(rows[:, first:last], axis=1).min() for first, last in _QUATERNIONS]
    return bool((rows[:-1, 0] > 0).all() and min(lengths) >= MIN_QUAT_LENGTH)


def _check_frame(file: MotionFile, number: int, frame: object, is_last: bool) -> None:
    where = f"{file.origin}: frame {number}"
    if not isinstance(frame, list) or len(frame) != ROW_SIZE:
        size = len(frame) if isinstance(frame, list) else 0
        raise InputFileError(f"{where} has {size} numbers, expected {ROW_SIZE}")
    if not all(isinstance(value, int | float) and abs(value) < 1e300 for value in frame):
        raise InputFileError(f"{where} holds something that is not a finite number")
    if not is_last and not frame[0] > 0:
        raise InputFileError(f"{where} lasts {frame[0]} s, expected more than 0")
    for name, _, _, (first, last) in _SKELETON:
        length = float(np.linalg.norm(frame[first:last]))
        if last - first == 4 and length < MIN_QUAT_LENGTH:
            raise InputFileError(f"{where}: the rotation of {name} has the length {length:.3g}, expected 1")


def _rotation(rows: np.ndarray, first: int, last: int) -> np.ndarray:
    if first == last:
        return np.tile([1.0, 0.0, 0.0, 0.0], (len(rows), 1))
    if last - first == 1:
        return rotations.from_axis_angle(np.array([0.0, -1.0, 0.0]), rows[:, first])
    quat = rows[:, first:last]
    return rotations.normalize(np.concatenate([quat[:, :1], _to_z_up(quat[:, 1:])], axis=-1))


def _to_z_up(vectors: np.ndarray) -> np.ndarray:
    """Turn x forward, y up, z right into x forward, y left, z up."""
    return vectors[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])
