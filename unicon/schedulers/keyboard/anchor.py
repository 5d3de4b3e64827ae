"""Where the frames of a source lie in the world: the executor sets them to the avatar's place when it begins.

From one frame as it was sent and as the executor anchored it follows, for the ground plane,

    turn = heading_w - heading,    offset_w = pos_w - R(turn) pos
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon import rotations
from unicon.schedulers.keyboard.ground_plane import rotated
from unicon.state import CharacterState


@dataclass(frozen=True)
class Anchor:
    """From the source's own frame to the world."""

    turn: float = 0.0
    """[rad]."""
    offset_w: tuple[float, float] = (0.0, 0.0)
    """[m]."""

    def to_world(self, pos: np.ndarray) -> np.ndarray:
        """Return the place in the world ``(2,)`` of one of the source ``(2,)``."""
        return rotated(pos, self.turn) + np.array(self.offset_w)

    def to_source(self, pos_w: np.ndarray) -> np.ndarray:
        """Return the place of the source ``(2,)`` of one in the world ``(2,)``."""
        return rotated(pos_w - np.array(self.offset_w), -self.turn)


def anchor_between(sent: CharacterState, anchored: CharacterState) -> Anchor:
    """Return the anchor that turned a frame that was sent into what the executor followed."""
    turn = float(rotations.heading_angle(anchored.root_quat_w) - rotations.heading_angle(sent.root_quat_w))
    offset = anchored.root_pos_w[:2] - rotated(sent.root_pos_w[:2], turn)
    return Anchor(turn, (float(offset[0]), float(offset[1])))
