"""A motion as a file has it: a skeleton of its own, and each joint's rotation over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon import rotations


@dataclass(frozen=True)
class SourceMotion:
    """T frames of a skeleton of J joints, z up; the first joint is the root.

    In the rest pose all rotations are the identity, so the offsets show which way each bone points then.
    """

    name: str
    family: str
    """Which mapping fits: the name of a file in ``mappings/``."""
    joint_names: tuple[str, ...]
    parents: np.ndarray
    """``(J,)``, -1 for the root; parents before children."""
    offsets: np.ndarray
    """Each joint in its parent's frame ``(J, 3)`` [m]."""
    times_s: np.ndarray
    """``(T,)``, rising."""
    root_pos: np.ndarray
    """``(T, 3)`` [m]."""
    local_quat: np.ndarray
    """Each joint against its parent ``(T, J, 4)``."""
    loop: bool = False
    """Whether it is cyclic."""
    source: str = ""
    licence: str = ""
    label: str = ""
    local_pos: np.ndarray | None = None
    """Each joint in its parent's frame ``(T, J, 3)`` [m] where that changes over time; None: the offsets."""

    def rest_positions(self) -> np.ndarray:
        """Return where the joints are in the rest pose ``(J, 3)`` [m], the root at the origin."""
        positions = np.zeros_like(self.offsets)
        for joint in range(1, len(self.parents)):
            positions[joint] = positions[self.parents[joint]] + self.offsets[joint]
        return positions

    def global_rotations(self) -> np.ndarray:
        """Return each joint's rotation ``(T, J, 4)`` in the world."""
        turns = self.local_quat.copy()
        for joint in range(1, len(self.parents)):
            turns[:, joint] = rotations.multiply(turns[:, self.parents[joint]], self.local_quat[:, joint])
        return turns

    def global_positions(self) -> np.ndarray:
        """Return each joint's position ``(T, J, 3)`` [m] in the world."""
        turns = self.global_rotations()
        positions = np.zeros((*self.local_quat.shape[:2], 3))
        positions[:, 0] = self.root_pos
        for joint in range(1, len(self.parents)):
            parent = self.parents[joint]
            place = self.offsets[joint] if self.local_pos is None else self.local_pos[:, joint]
            arm = rotations.rotate(turns[:, parent], place)
            positions[:, joint] = positions[:, parent] + arm
        return positions
