"""Reads poses kept as plain arrays, as AMP's and ASE's motions are: local rotations and the root's place.

Arrays: ``rotation`` (T, J, 4) of each joint against its parent, x, y, z, w; ``root_translation`` (T, 3) [m];
``fps`` [Hz]; ``node_names`` (J,); ``parent_indices`` (J,), -1 for the root; ``local_translation`` (J, 3) of
each joint in its parent's frame [m]. The axes are ours already: x forward, y left, z up.
"""

from __future__ import annotations

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.formats.array_file import Arrays
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.source_motion import SourceMotion

CUT_RATES_HZ = {23: 23.976, 29: 29.97, 59: 59.94, 119: 119.88}
"""Whole numbers that stand for broadcast rates, and those rates: ASE's files have them cut to integers."""
MIN_QUAT_LENGTH = 0.5
"""A shorter quaternion is no rounded unit quaternion but a defect."""


def read_poses(file: MotionFile) -> SourceMotion:
    """Read a motion.

    Raises:
        InputFileError: when an array is missing or not as it should be; the message names it.
    """
    arrays = Arrays(file)
    rotation = arrays.numbers("rotation", (None, None, 4))
    frames, joints, _ = rotation.shape
    if frames < 2:
        raise InputFileError(f"{file.origin}: has {frames} frames, expected 2 or more")
    offsets = arrays.numbers("local_translation", (joints, 3))
    offsets[0] = 0.0
    return SourceMotion(
        name=file.name,
        family="",
        joint_names=_names(arrays, joints),
        parents=_parents(arrays, joints),
        offsets=offsets,
        times_s=np.arange(frames) / _rate_hz(arrays),
        root_pos=arrays.numbers("root_translation", (frames, 3)),
        local_quat=_unit(arrays, rotation),
    )


def _rate_hz(arrays: Arrays) -> float:
    rate_hz = float(arrays.numbers("fps", ()))
    if not rate_hz > 0:
        raise InputFileError(f"{arrays.origin}: 'fps' is {rate_hz:g}, expected more than 0")
    return CUT_RATES_HZ.get(int(rate_hz), rate_hz) if rate_hz.is_integer() else rate_hz


def _names(arrays: Arrays, joints: int) -> tuple[str, ...]:
    names = arrays.get("node_names")
    if names.shape != (joints,) or names.dtype.kind not in "US":
        raise InputFileError(
            f"{arrays.origin}: 'node_names' has the shape {names.shape}, expected {joints} names"
        )
    return tuple(str(name) for name in names.astype(str))


def _parents(arrays: Arrays, joints: int) -> np.ndarray:
    parents = arrays.numbers("parent_indices", (joints,)).astype(int)
    if parents[0] != -1 or np.any(parents[1:] < 0) or np.any(parents >= np.arange(joints)):
        raise InputFileError(
            f"{arrays.origin}: 'parent_indices' is {parents.tolist()}, expected one root, which is first, "
            "and parents before children"
        )
    return parents


def _unit(arrays: Arrays, rotation: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(rotation, axis=-1)
    if lengths.min() < MIN_QUAT_LENGTH:
        frame, joint = np.unravel_index(int(lengths.argmin()), lengths.shape)
        raise InputFileError(
            f"{arrays.origin}: 'rotation' of joint {joint} in frame {frame + 1} has the length "
            f"{lengths.min():.3g}, expected unit quaternions"
        )
    return rotations.xyzw_to_wxyz(rotation / lengths[..., None])
