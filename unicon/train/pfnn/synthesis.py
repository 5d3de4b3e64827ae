"""Takes that were never captured, made of those that were: bent, reversed, faster or slower, put together.

- Bent: the heading is turned by the integral of a turn rate, and the root's velocity with it. The rate is
  weighted by how fast the root goes: who stands does not turn without stepping. Feet that stand do not turn
  with the body (strides.py).
- Reversed in time: a walk forward becomes one backward. Time-warped: as the dataset scheduler does.
- Sequences: standing, one or more motions, standing again, joined as the stitching scheduler joins clips.
- Calm upper body: arms and trunk that dribble or point are replaced by the mean of those of walks.

Afterwards feet are planted again (`unicon.motion.grounding`), without scaling the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from unicon import rotations, state
from unicon.humanoid import HUMANOID
from unicon.motion.clip import continuous_signs
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.ground import GroundConfig, Grounded, ground
from unicon.motion.grounding.root_scale import RootScaleConfig
from unicon.schedulers.inertialization import begin_after
from unicon.state import CharacterState, differentiate
from unicon.train.pfnn.strides import hold_foot_yaw

UPPER = np.array(
    [not any(part in name for part in ("hip", "knee", "ankle", "toe")) for name in HUMANOID.joint_names]
)
"""Which hinges are those above the hips ``(35,)``."""
_UNSCALED = GroundConfig(root_scale=RootScaleConfig(smallest=1.0, largest=1.0))
_MOVING_M_S = 0.4
_TURN_RAMP_S = 0.4


def plant(frames: CharacterState) -> Grounded:
    """Return a motion ``(T,)`` with its feet held where they stand, and when they do."""
    return ground(with_velocities(frames), _UNSCALED)


def bend(frames: CharacterState, turn_rate: float) -> CharacterState:
    """Return a motion ``(T,)`` along a path that turns by so much [rad/s] while it goes."""
    speed = gaussian_filter1d(np.linalg.norm(frames.root_lin_vel_w[:, :2], axis=-1), 8.0, mode="nearest")
    return _turned(frames, turn_rate * np.clip(speed / _MOVING_M_S, 0.0, 1.0))


def turn_round(frames: CharacterState, turn_rate: float) -> CharacterState:
    """Return steps on the spot ``(T,)`` that turn by so much [rad/s], slower at both ends."""
    times = np.arange(frames.batch_shape[0]) / RATE_HZ
    ends = np.minimum(times, times[-1] - times) / _TURN_RAMP_S
    return _turned(frames, turn_rate * np.clip(ends, 0.0, 1.0))


def _turned(frames: CharacterState, rate: np.ndarray) -> CharacterState:
    """Return a motion turned by the integral of a rate ``(T,)`` [rad/s], and its path with it."""
    turn = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]))]) / RATE_HZ
    heading = rotations.from_heading(turn)
    steps = np.diff(frames.root_pos_w, axis=0)
    steps = rotations.rotate(rotations.from_heading(0.5 * (turn[1:] + turn[:-1])), steps)
    pos_w = np.concatenate([frames.root_pos_w[:1], frames.root_pos_w[:1] + np.cumsum(steps, axis=0)])
    turned = replace(
        frames,
        root_pos_w=pos_w,
        root_quat_w=rotations.multiply(heading, frames.root_quat_w),
        joint_pos=hold_foot_yaw(frames, turn),
    )
    return with_velocities(turned)


def reverse(frames: CharacterState) -> CharacterState:
    """Return a motion ``(T,)`` played backwards."""
    return with_velocities(frames[::-1])


def calm_upper(frames: CharacterState, pose: np.ndarray) -> CharacterState:
    """Return a motion ``(T,)`` with the hinges above the hips of a pose ``(35,)``."""
    return with_velocities(replace(frames, joint_pos=np.where(UPPER, pose, frames.joint_pos)))


def sequence(parts: Sequence[CharacterState], transitions_s: Sequence[float]) -> CharacterState:
    """Return motions one after the other; the transitions are those into each but the first."""
    path = parts[0]
    for part, transition_s in zip(parts[1:], transitions_s, strict=True):
        path = with_velocities(state.concatenate([path, begin_after(part, path[-1], transition_s)]))
    return path


def with_velocities(frames: CharacterState) -> CharacterState:
    """Return a motion ``(T,)`` with the velocities of its poses."""
    quat = continuous_signs(frames.root_quat_w)
    return differentiate(frames.root_pos_w, quat, frames.joint_pos, RATE_HZ)
