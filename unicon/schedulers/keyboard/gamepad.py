"""What the sticks of a gamepad mean: as ``joy_node`` numbers them for the common game controllers.

Left stick: forward and sideways. Right stick: turn. A shoulder button held: jog; both: run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from unicon.schedulers.keyboard.command import LocomotionCommand


@dataclass(frozen=True)
class GamepadProfile:
    """Numbers of axes and buttons, and what full tilt is."""

    forward_axis: int = 1
    left_axis: int = 0
    turn_axis: int = 3
    jog_button: int = 5
    """Held to jog; with the run button, too, to run."""
    run_button: int = 4
    dead_zone: float = 0.1
    """Tilt below which a stick rests."""
    walk_m_s: float = 1.3
    jog_m_s: float = 2.2
    run_m_s: float = 2.5
    side_m_s: float = 0.6
    turn_rad_s: float = 1.2


def command_of(axes: Sequence[float], buttons: Sequence[int], profile: GamepadProfile) -> LocomotionCommand:
    """Return what the sticks ask for; axes and buttons that a device lacks rest."""
    speed = profile.walk_m_s
    if _pressed(buttons, profile.jog_button):
        speed = profile.run_m_s if _pressed(buttons, profile.run_button) else profile.jog_m_s
    forward = _tilt(axes, profile.forward_axis, profile.dead_zone)
    # nobody runs backward
    velocity = forward * (speed if forward > 0.0 else profile.walk_m_s)
    left = _tilt(axes, profile.left_axis, profile.dead_zone) * profile.side_m_s
    turn = _tilt(axes, profile.turn_axis, profile.dead_zone) * profile.turn_rad_s
    return LocomotionCommand((velocity, left), turn)


def _pressed(buttons: Sequence[int], number: int) -> bool:
    return number < len(buttons) and bool(buttons[number])


def _tilt(axes: Sequence[float], number: int, dead_zone: float) -> float:
    value = float(axes[number]) if number < len(axes) else 0.0
    if abs(value) < dead_zone:
        return 0.0
    size = min((abs(value) - dead_zone) / (1.0 - dead_zone), 1.0)
    return size if value > 0.0 else -size
