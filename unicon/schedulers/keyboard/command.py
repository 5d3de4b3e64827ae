"""Where somebody wants the character to go: checked, and no faster than the network was trained to."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

from unicon.errors import UniconError
from unicon.schedulers.pfnn.layout import GAITS
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard

_LEAST_M_S = 1e-3


@dataclass(frozen=True)
class LocomotionCommand:
    """A velocity and a turn, as seen from where the character faces."""

    velocity_h: tuple[float, float] = (0.0, 0.0)
    """Forward and to the left [m/s]."""
    turn_rate: float = 0.0
    """Of the facing, counter-clockwise [rad/s]; counts where no facing is given."""
    facing_w: float | None = None
    """Direction to face, counter-clockwise from the world's x axis [rad]; none: keep turning at the rate."""
    gait: str = ""
    """Gait whose range of speeds is to be kept; empty: whichever goes with the speed."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is not finite or there is no such gait."""
        numbers = (*self.velocity_h, self.turn_rate, self.facing_w or 0.0)
        if not all(math.isfinite(number) for number in numbers):
            raise UniconError(f"a locomotion command holds {numbers}, expected finite numbers")
        if self.gait and self.gait not in GAITS:
            raise UniconError(f"there is no gait {self.gait!r}; there are {', '.join(GAITS)}")

    @property
    def speed(self) -> float:
        """Along the ground [m/s]."""
        return math.hypot(*self.velocity_h)

    @property
    def stands(self) -> bool:
        """Whether it asks for standing still."""
        return self.speed < _LEAST_M_S and self.facing_w is None and abs(self.turn_rate) < _LEAST_M_S


STAND = LocomotionCommand()


class Clamped(NamedTuple):
    """A command that can be obeyed, and what was changed, in words."""

    command: LocomotionCommand
    changes: tuple[str, ...]


def clamp(command: LocomotionCommand, card: PhaseNetworkCard) -> Clamped:
    """Return the command within what a network was trained to do.

    The velocity is brought into the speeds of the gait that is asked for, and then into the ellipse through
    the limits forward or backward and sideways; the turn rate into its limit.
    """
    changes = []
    if command.gait not in ("", "stand", *card.gait_speeds_m_s):
        changes.append(f"gait {command.gait} to whichever goes with the speed")
        command = replace(command, gait="")
    velocity, limits = _into_gait(command, card), card.limits
    allowed = _allowed_share(velocity, limits)
    if allowed < 1.0 - 1e-9:
        if command.gait == "" or math.hypot(*velocity) <= command.speed:
            changes.append(f"speed {math.hypot(*velocity):.2f} to {allowed * math.hypot(*velocity):.2f} m/s")
        velocity = (velocity[0] * allowed, velocity[1] * allowed)
    largest = limits.get("turn_rad_s", 0.0)
    turn_rate = min(max(command.turn_rate, -largest), largest)
    if abs(turn_rate - command.turn_rate) > 1e-9:
        changes.append(f"turn rate {command.turn_rate:.2f} to {turn_rate:.2f} rad/s")
    return Clamped(replace(command, velocity_h=velocity, turn_rate=turn_rate), tuple(changes))


def _into_gait(command: LocomotionCommand, card: PhaseNetworkCard) -> tuple[float, float]:
    """Return the velocity at a speed of the gait that is asked for, in the same direction."""
    x, y = command.velocity_h
    if command.gait == "stand" or command.speed < _LEAST_M_S:
        return 0.0, 0.0
    if command.gait not in card.gait_speeds_m_s:
        return x, y
    slow, _, fast = card.gait_speeds_m_s[command.gait]
    share = min(max(command.speed, slow), fast) / command.speed
    return x * share, y * share


def _allowed_share(velocity: tuple[float, float], limits: Mapping[str, float]) -> float:
    x, y = velocity
    along = limits.get("forward_m_s", 0.0) if x >= 0.0 else limits.get("backward_m_s", 0.0)
    across = limits.get("sideways_m_s", 0.0)
    if (abs(x) > _LEAST_M_S and along <= 0.0) or (abs(y) > _LEAST_M_S and across <= 0.0):
        return 0.0
    size = math.hypot(x / along if along else 0.0, y / across if across else 0.0)
    return min(1.0, 1.0 / size) if size > 0.0 else 1.0
