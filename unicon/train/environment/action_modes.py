"""What the policy's 35 outputs a do to the joints; all are in shares of the effort factors.

``q*`` and ``dq*`` are the hinges of the nearest target frame that the policy sees, q and dq the avatar's.

torque         torque = effort a, held over the control step: the paper's.
torque-servo   torque = effort a + stiffness (q* - q) + damping dq*, held over a tick of 1/60 s. At 30 Hz
               control a is held for two ticks and the servo's part computed again for the second, with its
               own target. It is what ``unicon.policy.NetworkPolicy`` does.
pd             the same formula in every physics step, with a, q* and dq* held over the control step: a
               servo within the physics that a offsets.
kinematic      a does nothing: the avatar is put into the target's pose.

All are cut off at the effort factors; the damping -damping dq is passive and always there.

From pd to torque-servo: the formula is the same, so the same network is a torque-servo policy. What changes
is that the servo acts on the state at the beginning of a tick. Held for 1/60 s it is stable, and costs a
little on acrobatics; held for 1/30 s it is not. So train with pd at 30 Hz and export as torque-servo at
60 Hz, with the same stride.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from unicon.control import Control, ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import RATE_HZ
from unicon.state import CharacterState

ActionMode = Literal["torque", "torque-servo", "pd", "kinematic"]

_EFFORT = HUMANOID.effort.astype(np.float32)
_STIFFNESS = HUMANOID.stiffness.astype(np.float32)
_DAMPING = HUMANOID.damping.astype(np.float32)


def ticks_held(mode: ActionMode, control_hz: int) -> int:
    """Return for how many ticks of 1/60 s a control of this mode stays the same."""
    return 1 if mode == "torque-servo" else round(RATE_HZ / control_hz)


def make_control(
    mode: ActionMode, actions: np.ndarray, actual: CharacterState, target: CharacterState
) -> Control:
    """Return the control ``(N, 35)`` that actions ``(N, 35)`` mean.

    Args:
        mode: any but "kinematic", which needs no control.
        actions: the policy's outputs.
        actual: the avatars ``(N)``.
        target: the nearest target frames that they see ``(N)``.
    """
    torque = _EFFORT * actions
    if mode == "torque":
        return TorqueControl(torque)
    if mode == "torque-servo":
        torque += _STIFFNESS * (target.joint_pos - actual.joint_pos) + _DAMPING * target.joint_vel
        return TorqueControl(torque)
    # stiffness (q* + effort a / stiffness - q) = stiffness (q* - q) + effort a
    return ServoControl(target.joint_pos + torque / _STIFFNESS, target.joint_vel)
