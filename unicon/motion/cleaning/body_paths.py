"""Where the parts of the body are over time: the forward kinematics of the joints that cleaning looks at."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from unicon import rotations
from unicon.motion.retargeting.skeletons import load_mapping
from unicon.motion.source_motion import SourceMotion


@dataclass(frozen=True)
class BodyPaths:
    """T frames of the parts of the body that the skeleton has, and of the joints from the root to them: K."""

    parts: dict[str, int]
    """Row of each part (pelvis, left_foot ...) among the K joints."""
    joints: np.ndarray
    """Index of each of the K joints in the source; parents before children."""
    times_s: np.ndarray
    """``(T,)``."""
    pos_w: np.ndarray
    """``(T, K, 3)`` [m]."""
    rot_w: np.ndarray
    """``(T, K, 4)``."""
    local_quat: np.ndarray
    """``(T, K, 4)`` against the parent."""
    leg_m: float
    """From hip to ankle."""

    @property
    def rate_hz(self) -> float:
        """The usual number of frames a second."""
        return float(1.0 / np.median(np.diff(self.times_s)))

    @property
    def body_rows(self) -> np.ndarray:
        """Rows of all parts."""
        return np.unique(list(self.parts.values()))

    def pos(self, part: str) -> np.ndarray:
        """Return a part's position ``(T, 3)`` [m]."""
        return self.pos_w[:, self.parts[part]]

    def quat(self, part: str) -> np.ndarray:
        """Return a part's rotation ``(T, 4)`` in the world."""
        return self.rot_w[:, self.parts[part]]

    def of(self, names: Sequence[str]) -> np.ndarray:
        """Return positions ``(T, N, 3)`` of those of the named parts that there are."""
        return self.pos_w[:, [self.parts[name] for name in names if name in self.parts]]

    def take(self, frames: np.ndarray | slice) -> BodyPaths:
        """Return some of the frames."""
        arrays = ("times_s", "pos_w", "rot_w", "local_quat")
        return replace(self, **{name: getattr(self, name)[frames] for name in arrays})

    def backwards(self) -> BodyPaths:
        """Return the frames in the opposite order of time."""
        turned = self.take(slice(None, None, -1))
        return replace(turned, times_s=self.times_s[-1] - turned.times_s)

    def speeds(self) -> np.ndarray:
        """Return how fast each joint is on the way to the next frame ``(T-1, K)`` [m/s]."""
        steps = np.linalg.norm(np.diff(self.pos_w, axis=0), axis=-1)
        return steps / np.diff(self.times_s)[:, None]

    def turn_speeds(self) -> np.ndarray:
        """Return how fast each joint turns against its parent until the next frame ``(T-1, K)`` [rad/s]."""
        return turn_angles(self.local_quat) / np.diff(self.times_s)[:, None]


def body_paths(motion: SourceMotion) -> BodyPaths:
    """Return where the parts of a recognised skeleton are.

    Raises:
        InputFileError: when there is no mapping for its family.
    """
    present = load_mapping(motion.family).present(motion)
    joints = _with_ancestors(motion.parents, present.values())
    row = {joint: k for k, joint in enumerate(joints.tolist())}
    pos_w = np.zeros((len(motion.times_s), len(joints), 3))
    rot_w = np.zeros((len(motion.times_s), len(joints), 4))
    for k, joint in enumerate(joints.tolist()):
        parent = int(motion.parents[joint])
        if parent < 0:
            pos_w[:, k], rot_w[:, k] = motion.root_pos, motion.local_quat[:, joint]
            continue
        above = row[parent]
        place = motion.offsets[joint] if motion.local_pos is None else motion.local_pos[:, joint]
        rot_w[:, k] = rotations.multiply(rot_w[:, above], motion.local_quat[:, joint])
        pos_w[:, k] = pos_w[:, above] + rotations.rotate(rot_w[:, above], place)
    parts = {part: row[joint] for part, joint in present.items()}
    return BodyPaths(
        parts, joints, motion.times_s, pos_w, rot_w, motion.local_quat[:, joints], _leg(pos_w, parts)
    )


def turn_angles(quat: np.ndarray, step: int = 1) -> np.ndarray:
    """Return the angle ``(T-step, ...)`` [rad] between rotations ``(T, ..., 4)`` and those ``step`` later.

    Exact to 3e-8 rad, by the arc cosine of the product, which is the fastest way.
    """
    cosine = np.abs(np.einsum("...i,...i->...", quat[:-step], quat[step:]))
    return 2.0 * np.arccos(np.minimum(cosine, 1.0))


def _with_ancestors(parents: np.ndarray, joints: Iterable[int]) -> np.ndarray:
    keep: set[int] = set()
    for joint in joints:
        while joint >= 0 and joint not in keep:
            keep.add(joint)
            joint = int(parents[joint])
    return np.array(sorted(keep))


def _leg(pos_w: np.ndarray, parts: dict[str, int]) -> float:
    hip, knee, ankle = (pos_w[0, parts[f"left_{part}"]] for part in ("thigh", "shin", "foot"))
    return float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee))
