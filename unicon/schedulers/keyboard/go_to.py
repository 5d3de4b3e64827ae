"""Walking to a point: which command brings the character there, and how far it is.

Far away it faces the point and walks; it slows down in proportion to the distance, within ``NEAR_M`` it steps
straight at it whatever it faces, and within ``ARRIVED_M`` it stops and turns to the facing that is asked for.
It has arrived when it has stood there for a moment, within ``LEFT_M``:

    speed = min(speed wanted, distance / SLOW_S)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.keyboard.command import STAND, LocomotionCommand

SLOW_S = 0.9
NEAR_M, ARRIVED_M, LEFT_M = 0.6, 0.18, 0.3
FACING_RAD = 0.2
REST_S = 0.7
"""It has arrived when it has stood there for so long."""
STUCK_S = 5.0
"""No nearer for so long: it gives up."""
_SLOWEST_M_S = 0.35
_PROGRESS_M = 0.03

GoToState = Literal["going", "arrived", "stuck"]


class Progress(NamedTuple):
    """How it goes."""

    state: GoToState
    distance_m: float
    share: float
    """Of the way that is done, 0..1."""
    command: LocomotionCommand


@dataclass(frozen=True)
class Destination:
    """Where to, in the frame in which the character's place is given."""

    pos_w: tuple[float, float]
    """[m]."""
    facing_w: float | None = None
    """Direction to face in the end [rad]; none: as it comes."""
    speed_m_s: float = 1.1
    """On the way."""


class GoTo:
    """Steers to a destination, asked once a frame."""

    def __init__(self, destination: Destination, pos_w: np.ndarray) -> None:
        self.destination = destination
        self._whole_m = max(float(np.linalg.norm(np.array(destination.pos_w) - pos_w)), 1e-6)
        self._nearest_m, self._idle_frames = self._whole_m, 0
        self._stopped, self._rest_frames = False, 0

    def steer(self, pos_w: np.ndarray, heading: float) -> Progress:
        """Return what to do from a place ``(2,)`` [m] and heading [rad]."""
        offset = np.array(self.destination.pos_w) - pos_w
        distance = float(np.linalg.norm(offset))
        self._watch(distance)
        # once it has stopped it does not set off again for a few centimetres
        self._stopped = distance < (LEFT_M if self._stopped else ARRIVED_M)
        share = float(np.clip(1.0 - distance / self._whole_m, 0.0, 1.0))
        if self._idle_frames > STUCK_S * RATE_HZ and not self._stopped:
            return Progress("stuck", distance, share, STAND)
        if self._stopped:
            turned = self._is_turned(heading)
            self._rest_frames = self._rest_frames + 1 if turned else 0
            command = STAND if turned else LocomotionCommand(facing_w=self.destination.facing_w)
            arrived = self._rest_frames > REST_S * RATE_HZ
            return Progress("arrived" if arrived else "going", distance, share, command)
        self._rest_frames = 0
        return Progress("going", distance, share, self._walk(offset, distance, heading))

    def _walk(self, offset: np.ndarray, distance: float, heading: float) -> LocomotionCommand:
        speed = min(self.destination.speed_m_s, max(distance / SLOW_S, _SLOWEST_M_S))
        bearing = float(np.arctan2(offset[1], offset[0]))
        off = float(np.remainder(bearing - heading + np.pi, 2.0 * np.pi) - np.pi)
        if distance < NEAR_M:
            return LocomotionCommand((speed * float(np.cos(off)), speed * float(np.sin(off))))
        # who faces away turns first, in a tight curve
        forward = speed * max(float(np.cos(off)), 0.25)
        return LocomotionCommand((forward, 0.0), facing_w=bearing)

    def _watch(self, distance: float) -> None:
        if distance < self._nearest_m - _PROGRESS_M:
            self._nearest_m, self._idle_frames = distance, 0
        else:
            self._idle_frames += 1

    def _is_turned(self, heading: float) -> bool:
        facing = self.destination.facing_w
        if facing is None:
            return True
        return abs(np.remainder(facing - heading + np.pi, 2.0 * np.pi) - np.pi) < FACING_RAD
