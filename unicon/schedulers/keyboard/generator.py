"""The next pose from the last one and the path ahead, again and again (Holden et al. 2017, section 7).

In every frame the path is steered, the network is asked, and its answer moves the root, turns the phase and
gives the pose. Where nothing moves in the second ahead, root and phase come to rest:

    amount = (1 - standing)^(1/4)       multiplies the root's velocity, its turn rate and the phase's

so that who stands does stand, and does not creep.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.observation import observe
from unicon.schedulers.keyboard.command import LocomotionCommand
from unicon.schedulers.keyboard.ground_plane import rotated
from unicon.schedulers.keyboard.pace_limit import PaceLimit, PaceLimitConfig
from unicon.schedulers.keyboard.path import HERE, PathConfig, SteeredPath
from unicon.schedulers.keyboard.steering import Steering, SteeringConfig
from unicon.schedulers.pfnn.layout import pack_input, unpack_output
from unicon.state import CharacterState, move

_STAND_POWER = 0.25


class PoseNetwork(Protocol):
    """What makes poses: `unicon.schedulers.pfnn.network.PhaseNetwork`."""

    def predict(self, x: np.ndarray, phase: float) -> np.ndarray:
        """Return y for x at a phase, as in `unicon.schedulers.pfnn.layout`."""
        ...


@dataclass(frozen=True)
class GeneratorConfig:
    """How poses are made."""

    path: PathConfig = field(default_factory=PathConfig)
    steering: SteeringConfig = field(default_factory=SteeringConfig)
    pace: PaceLimitConfig = field(default_factory=PaceLimitConfig)
    largest_turn: float = 2.0
    """Turn rate with which a facing that is asked for is approached [rad/s]."""


class PoseGenerator:
    """A character that goes where it is told, one frame of 1/60 s at a time."""

    def __init__(self, network: PoseNetwork, config: GeneratorConfig) -> None:
        self.network, self.config = network, config
        self.failures = 0
        """How often the network's answer made no finite pose, and the character stood again."""
        self._begin(HUMANOID.rest_state())

    def _begin(self, state: CharacterState) -> None:
        heading = float(rotations.heading_angle(state.root_quat_w))
        self.state, self.phase, self.contacts = state, 0.0, np.zeros(4)
        self.path = SteeredPath(self.config.path, state.root_pos_w[:2], heading, self.config.largest_turn)
        self.steering = Steering(self.config.steering, heading)
        self.pace = PaceLimit(self.config.pace)

    @property
    def heading(self) -> float:
        """Where the root faces, without jumps [rad]."""
        return float(self.path.heading[HERE])

    def place(self, pos_w: np.ndarray, heading: float) -> None:
        """Turn and shift the character, and its path, along the ground.

        Args:
            pos_w: where the root shall be ``(2,)`` [m].
            heading: where it shall face [rad].
        """
        turn = np.array(heading - self.heading)
        self.steering.turn(float(turn))
        turned = move(self.state, turn, np.zeros(3))
        offset = np.append(np.asarray(pos_w) - turned.root_pos_w[:2], 0.0)
        self.state = move(turned, np.array(0.0), offset)
        self.path.place(np.asarray(pos_w, np.float64), heading)

    def step(self, command: LocomotionCommand) -> CharacterState:
        """Make the next frame, and return it."""
        pos_w, heading = self.path.pos_w[HERE].copy(), self.heading
        self.path.steer(self.steering.steer(command, heading))
        x = pack_input(self.path.samples(), observe(self.state, forward_kinematics(self.state)))
        y = self.network.predict(x, self.phase)
        # finite numbers may still make no rotation, or overflow
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            state = self._follow(unpack_output(y)) if np.isfinite(y).all() else None
        if state is None or not all(np.isfinite(values).all() for values in vars(state).values()):
            return self._stand_again(pos_w, heading)
        self.state = state
        return state

    def _follow(self, parts: dict[str, np.ndarray]) -> CharacterState:
        """Go on by the network's answer, and return the pose there."""
        amount = (1.0 - self.path.standing) ** _STAND_POWER
        amount *= self.pace.share(amount * float(np.linalg.norm(parts["root_vel_h"])))
        turn = amount * float(parts["turn_rate"][0]) / RATE_HZ
        step_h = amount * parts["root_vel_h"] / RATE_HZ
        self.steering.observe(step_h * RATE_HZ)
        step_w = rotated(step_h, self.heading)
        self.path.advance(step_w, turn, parts["path_pos_h"], parts["path_facing_h"])
        rate = max(float(parts["phase_rate"][0]), 0.0)
        self.phase = (self.phase + amount * rate / RATE_HZ) % (2.0 * np.pi)
        self.contacts = parts["contacts"]
        return self._pose(parts, amount)

    def _pose(self, parts: dict[str, np.ndarray], amount: float) -> CharacterState:
        """Return the pose of the network's answer where the path is now."""
        last = self.state
        tilt = quat_from_rot6d(parts["root_rot6d_h"])
        tilt = rotations.multiply(rotations.conjugate(rotations.heading(tilt)), tilt)
        quat_w = rotations.multiply(rotations.from_heading(np.array(self.heading)), tilt)
        pos_w = np.append(self.path.pos_w[HERE], parts["root_height"])
        turn = rotations.multiply(quat_w, rotations.conjugate(last.root_quat_w))
        return CharacterState(
            root_pos_w=pos_w,
            root_quat_w=quat_w,
            root_lin_vel_w=(pos_w - last.root_pos_w) * RATE_HZ,
            root_ang_vel_w=rotations.to_rotation_vector(turn) * RATE_HZ,
            joint_pos=np.clip(parts["joint_pos"], HUMANOID.joint_lower, HUMANOID.joint_upper),
            joint_vel=amount * parts["joint_vel"],
        )

    def _stand_again(self, pos_w: np.ndarray, heading: float) -> CharacterState:
        self.failures += 1
        self._begin(HUMANOID.rest_state())
        self.place(pos_w, heading)
        return self.state


def quat_from_rot6d(rot6d: np.ndarray) -> np.ndarray:
    """Return the unit quaternion ``(4,)`` of two columns ``(6,)`` that need be neither unit nor square."""
    x = rot6d[:3] / np.linalg.norm(rot6d[:3])
    y = rot6d[3:] - x * (x @ rot6d[3:])
    y /= np.linalg.norm(y)
    return rotations.from_matrix(np.stack([x, y, np.cross(x, y)], axis=-1))
