"""The formats that motions are read from."""

from __future__ import annotations

from collections.abc import Callable

from unicon.errors import InputFileError
from unicon.motion.formats.array_file import list_arrays
from unicon.motion.formats.asf_amc import read_amc
from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.deepmimic import read_deepmimic
from unicon.motion.formats.joint_angles_npz import read_joint_angles
from unicon.motion.formats.motion_file import ARCHIVE_SUFFIX, MotionFile
from unicon.motion.formats.pose_npz import read_poses
from unicon.motion.source_motion import SourceMotion


def read_arrays(file: MotionFile) -> SourceMotion:
    """Read an .npz file: joint angles of a biomechanical model, or the poses of a skeleton.

    Raises:
        InputFileError: when it is neither.
    """
    names = list_arrays(file)
    if "rotation" in names:
        return read_poses(file)
    if "q_pelvis_tilt" in names:
        return read_joint_angles(file)
    raise InputFileError(
        f"{file.origin}: holds the arrays {', '.join(names[:8]) or 'of no name'}, expected those of poses "
        "('rotation', 'root_translation' ...) or of joint angles ('q_pelvis_tilt' ...)"
    )


MOTION_READERS: dict[str, Callable[[MotionFile], SourceMotion]] = {
    ".amc": read_amc,
    ".bvh": read_bvh,
    ".json": read_deepmimic,
    ".npz": read_arrays,
    ".txt": read_deepmimic,
}
"""What reads files of each suffix."""


def read_motion(file: MotionFile) -> SourceMotion:
    """Read a motion of any known format: axes z up, x forward, y left; lengths in the file's units.

    Raises:
        InputFileError: when it is no whole motion, or of a format that is not known.
    """
    reader = MOTION_READERS.get(file.suffix)
    if reader is not None:
        return reader(file)
    if file.suffix == ARCHIVE_SUFFIX:
        raise InputFileError(f"{file.origin}: is no whole zip archive; copy or pack it again")
    known = ", ".join(MOTION_READERS)
    raise InputFileError(f"{file.origin}: there is no reader for {file.suffix!r} files, only for {known}")
