"""What a policy may ask of the joints for one tick."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TorqueControl:
    """Torques held over the tick."""

    torque: np.ndarray
    """``(35,)`` [N m]; what exceeds the effort factors is cut off."""


@dataclass(frozen=True)
class ServoControl:
    """Positions and velocities that the servos of the joints aim at, in every physics step.

    torque = stiffness (joint_pos - q) + damping (joint_vel - dq); the first part and the velocity's
    feed-forward are limited by the effort factors, the damping of the joint itself is passive.
    """

    joint_pos: np.ndarray
    """``(35,)`` [rad]."""
    joint_vel: np.ndarray
    """``(35,)`` [rad/s]."""


Control = TorqueControl | ServoControl
