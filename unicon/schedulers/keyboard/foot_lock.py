"""Holds feet where they stand, after the network: an option, which the paper leaves off.

While the network says that a foot stands, its ankle is shifted so that the point of contact (heel, ball, or
in between as the foot rolls over) makes no step:

    shift_t = shift_t-1 - (step of the point of contact as generated)

The shift is no longer than ``largest_m``. While the foot stands it only creeps back, by ``creep_m_s``, so
that nobody stands for long with feet pulled together; of a foot that was lifted it dies away. A standing
foot is brought to the floor as well, and where a leg is too short for its foot the root sinks, both with a
lag, so that nothing jerks:

    lift <- lift + (-height - lift) / (1 + 60 settle_s)
    drop <- drop + (what the leg lacks - drop) / (1 + 60 settle_s)

The generator goes on from its own, unlocked pose, so nothing of it feeds back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from unicon import state
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.leg_ik import SIDES, leg_of, missing_reach, move_foot
from unicon.schedulers.keyboard.ground_plane import rotated
from unicon.state import CharacterState

_LEAST_M = 5e-5
"""A smaller shift is not worth moving a leg for."""


@dataclass(frozen=True)
class FootLockConfig:
    """When feet are held, and how far."""

    begin: float = 0.6
    """A foot is held from when the network is so sure that it stands."""
    end: float = 0.4
    """And until it is no surer than this."""
    largest_m: float = 0.10
    """No foot is shifted further."""
    creep_m_s: float = 0.012
    """Speed at which the shift of a standing foot goes back [m/s]."""
    release_s: float = 0.08
    """Time in which the shift of a foot that is lifted dies away to a third."""
    settle_s: float = 0.03
    """Time in which a standing foot comes to the floor, and the root sinks, by more than half."""
    largest_drop_m: float = 0.05
    """The root sinks by no more than this for a leg that is too short."""


class FootLock:
    """Both feet of a character, frame after frame."""

    def __init__(self, config: FootLockConfig) -> None:
        self._config = config
        self._standing = np.zeros(2, dtype=bool)
        self._shift_w = np.zeros((2, 2))
        self._lift, self._drop = np.zeros(2), 0.0
        self._last: tuple[np.ndarray, np.ndarray] | None = None
        self._last_change = np.zeros(35)

    def lock(self, frame: CharacterState, contacts: np.ndarray) -> CharacterState:
        """Return a frame with its standing feet where they stood.

        Args:
            frame: as generated.
            contacts: how sure the network is of the contacts ``(4,)``, in the order of the layout.
        """
        config = self._config
        batch = state.stack([frame])
        bodies = forward_kinematics(batch)
        soles = Soles(bodies)
        sure = contacts.reshape(2, 2).max(axis=1)
        self._standing = sure > np.where(self._standing, config.end, config.begin)
        self._update(soles.points_w[0, ..., :2], soles.weights[0])
        self._lift += self._lag * (np.where(self._standing, -soles.heights[0], 0.0) - self._lift)
        offset_w = np.concatenate([self._shift_w, self._lift[:, None]], axis=-1)
        sunk = self._sink(frame, bodies, offset_w)
        offset_w[:, 2] += self._drop
        joint_pos = batch.joint_pos
        for foot, side in enumerate(SIDES):
            if np.abs(offset_w[foot]).max() > _LEAST_M:
                joint_pos = move_foot(joint_pos, bodies, side, offset_w[foot, None])
        change = joint_pos[0] - frame.joint_pos
        rate = (change - self._last_change) * RATE_HZ
        self._last_change = change
        return replace(sunk, joint_pos=joint_pos[0], joint_vel=frame.joint_vel + rate)

    def reset(self) -> None:
        """Forget where feet stood: the character was placed elsewhere."""
        self._last, self._shift_w = None, np.zeros((2, 2))
        self._lift, self._drop = np.zeros(2), 0.0
        self._last_change = np.zeros(35)

    def move(self, turn: float, before: np.ndarray, after: np.ndarray) -> None:
        """Go along with a character that is turned and shifted: feet stay where they are against it.

        Args:
            turn: by how much [rad].
            before: where its root was ``(2,)`` [m].
            after: where it is then ``(2,)`` [m].
        """
        self._shift_w = rotated(self._shift_w, turn)
        if self._last is not None:
            points_w, weights = self._last
            self._last = rotated(points_w - before, turn) + after, weights

    @property
    def _lag(self) -> float:
        """Share of the way that lift and drop go in a frame."""
        return 1.0 / (1.0 + self._config.settle_s * RATE_HZ)

    def _sink(self, frame: CharacterState, bodies: BodyKinematics, offset_w: np.ndarray) -> CharacterState:
        """Return the frame with its root lower, for standing feet to be shifted ``(2, 3)``."""
        legs = [leg_of(side) for side in SIDES]
        hips_w, ankles_w = (
            bodies.pos_w[0, [getattr(leg, part) for leg in legs]] for part in ("thigh", "foot")
        )
        missing = self._standing * missing_reach(hips_w, ankles_w, offset_w)
        change = self._lag * (min(float(missing.max()), self._config.largest_drop_m) - self._drop)
        self._drop += change
        return replace(
            frame,
            root_pos_w=frame.root_pos_w - [0.0, 0.0, self._drop],
            root_lin_vel_w=frame.root_lin_vel_w - [0.0, 0.0, change * RATE_HZ],
        )

    def _update(self, points_w: np.ndarray, weights: np.ndarray) -> None:
        """Take in where heels and balls are ``(2, 2, 2)`` and what they carry ``(2, 2)``."""
        if self._last is not None:
            before_w, before = self._last
            carried = 0.5 * (weights + before)[..., None]
            self._shift_w -= self._standing[:, None] * np.sum(carried * (points_w - before_w), axis=1)
        lengths = np.linalg.norm(self._shift_w, axis=-1)
        too_far = lengths > self._config.largest_m
        self._shift_w[too_far] *= (self._config.largest_m / lengths[too_far])[:, None]
        creep = self._config.creep_m_s / RATE_HZ
        self._shift_w *= np.maximum(1.0 - creep / np.maximum(lengths, 1e-9), 0.0)[:, None]
        self._shift_w[~self._standing] *= np.exp(-1.0 / (self._config.release_s * RATE_HZ))
        self._last = points_w, weights
