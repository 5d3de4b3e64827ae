"""Retargeting frame by frame with mink's inverse kinematics, in the way of GMR.

GMR (Ze et al. 2025, General Motion Retargeting) gives each body of the robot that a person's joint plays a
target place and rotation, and takes steps of a quadratic program from the last frame's pose until the error
gets no smaller by 0.001, at most ten a stage: first with costs on rotations and the feet's places, then
with costs on all places. Costs, damping, solver and the order of stages are those of its tables for
motion capture; the targets are our scaled source's, so that both are measured against the same places.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import mink
import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import compile_model
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.retargeting.frames import frame, unit
from unicon.motion.retargeting.limbs import LIMBS
from unicon.motion.retargeting.scaled_source import ScaledSource
from unicon.state import CharacterState, differentiate

SOLVER = "daqp"
FIRST_SWEEPS = 10
"""The first frame starts from the zero pose, so it gets more steps than GMR gives it."""


class Costs(NamedTuple):
    """Costs of a body's distance [1/m] and turn [1/rad] from its target, in both stages."""

    place_1: float
    turn_1: float
    place_2: float
    turn_2: float


_BOTH_SIDES = {
    "thigh": Costs(0, 10, 10, 5),
    "shin": Costs(0, 10, 10, 5),
    "foot": Costs(100, 10, 50, 10),
    "upper_arm": Costs(0, 10, 50, 5),
    "forearm": Costs(0, 10, 10, 5),
    "hand": Costs(0, 10, 50, 5),
}
COSTS = {
    "pelvis": Costs(0, 10, 10, 5),
    "chest": Costs(0, 100, 0, 5),
    "head": Costs(0, 10, 10, 5),
    **{f"{side}_{part}": costs for side in ("left", "right") for part, costs in _BOTH_SIDES.items()},
}


@dataclass(frozen=True)
class MinkConfig:
    """How the steps of inverse kinematics are taken; as GMR does by default."""

    damping: float = 0.5
    task_damping: float = 1.0
    """Levenberg-Marquardt damping of each task."""
    least_gain: float = 0.001
    """A stage ends when a step makes the error smaller by less than this."""
    steps: int = 10
    """Most steps that follow the first of a stage."""


class Target(NamedTuple):
    """Where a body should be over time."""

    pos_w: np.ndarray
    """``(T, 3)`` [m]"""
    quat_w: np.ndarray
    """``(T, 4)``"""
    has_turn: bool
    """Whether the source tells its rotation."""


class MinkResult(NamedTuple):
    """A motion as mink fits it."""

    frames: CharacterState
    """Batch ``(T,)`` at 60 Hz."""
    steps_per_frame: float
    """Mean number of quadratic programs solved."""


def body_targets(source: ScaledSource) -> dict[str, Target]:
    """Return the targets of all bodies with costs: places of the joints, rotations by constant offsets."""
    turns, alignment = source.turns, source.alignment
    quats = {part: rotations.multiply(turns[part], alignment.trunk) for part in ("pelvis", "chest")}
    quats["head"] = rotations.multiply(turns["head"], alignment.head)
    for side in ("left", "right"):
        quats[f"{side}_foot"] = rotations.multiply(turns[f"{side}_foot"], alignment.feet[side])
    for limb in LIMBS:
        ends = (*limb.parts, f"{limb.parts[2]}_tip")
        for part, end in zip(limb.parts, ends[1:], strict=True):
            if part not in quats and end in source.positions and part in turns:
                quats[part] = _limb_turn(source, part, end, alignment.hinge_axes[limb.upper])
    hips_middle = np.mean(
        [HUMANOID.offsets[HUMANOID.body_names.index(f"{s}_thigh")] for s in ("left", "right")], 0
    )
    places = source.positions | {"pelvis": -rotations.rotate(quats["pelvis"], hips_middle)}
    still = np.tile([1.0, 0.0, 0.0, 0.0], (len(source.hips_w), 1))
    return {
        body: Target(source.hips_w + places[body], quats.get(body, still), body in quats)
        for body in COSTS
        if body in places
    }


def _limb_turn(source: ScaledSource, part: str, end: str, hinge_axis: np.ndarray) -> np.ndarray:
    """Return a limb's turns ``(T, 4)``: our z axis against its bone, our y axis along its hinge's."""
    turn = source.turns[part]
    bone = rotations.rotate_inverse(turn, source.positions[end] - source.positions[part]).mean(axis=0)
    return rotations.multiply(turn, frame(-unit(bone), hinge_axis))


class MinkRetargeter:
    """Retargets motions with the same targets' bodies."""

    def __init__(self, config: MinkConfig) -> None:
        self.config, self.model = config, compile_model()
        self.limits = [mink.ConfigurationLimit(self.model)]

    def retarget(self, targets: dict[str, Target]) -> MinkResult:
        """Return the motion frame by frame, each beginning with the pose before."""
        stages = [self._tasks(targets, stage) for stage in (0, 1)]
        poses = np.zeros((len(targets["pelvis"].pos_w), self.model.nq))
        configuration = mink.Configuration(self.model, self._first_pose(targets["pelvis"]))
        count = 0
        for t in range(len(poses)):
            for tasks in stages:
                for body, task in tasks.items():
                    place = np.concatenate([targets[body].quat_w[t], targets[body].pos_w[t]])
                    task.set_target(mink.SE3(place))
            for _ in range(1 if t else FIRST_SWEEPS):
                count += sum(self._descend(configuration, list(tasks.values())) for tasks in stages)
            poses[t] = configuration.q
        frames = differentiate(poses[:, :3], poses[:, 3:7], poses[:, 7:], RATE_HZ)
        return MinkResult(frames, count / len(poses))

    def _descend(self, configuration: mink.Configuration, tasks: list[mink.FrameTask]) -> int:
        """Take steps until the error gets no smaller; return their number."""
        dt, error = self.model.opt.timestep, _error(configuration, tasks)
        for step in range(1, self.config.steps + 2):
            velocity = mink.solve_ik(
                configuration, tasks, dt, SOLVER, damping=self.config.damping, limits=self.limits
            )
            configuration.integrate_inplace(velocity, dt)
            before, error = error, _error(configuration, tasks)
            if before - error <= self.config.least_gain:
                return step
        return self.config.steps + 1

    def _tasks(self, targets: dict[str, Target], stage: int) -> dict[str, mink.FrameTask]:
        tasks = {}
        for body, target in targets.items():
            place, turn = COSTS[body][2 * stage : 2 * stage + 2]
            turn *= target.has_turn
            if place or turn:
                damping = self.config.task_damping
                tasks[body] = mink.FrameTask(body, "body", place, turn, lm_damping=damping)
        return tasks

    def _first_pose(self, pelvis: Target) -> np.ndarray:
        pose = self.model.qpos0.copy()
        pose[:3], pose[3:7] = pelvis.pos_w[0], pelvis.quat_w[0]
        return pose


def _error(configuration: mink.Configuration, tasks: list[mink.FrameTask]) -> float:
    return float(np.linalg.norm(np.concatenate([task.compute_error(configuration) for task in tasks])))
