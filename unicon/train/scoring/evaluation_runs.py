"""Runs clips: an avatar starts in a clip's first frame and follows it to its end, at 60 Hz in MuJoCo.

Every clip has a ``unicon.simulation.Simulation`` of its own, the executor's; the policy looks at all of them
at once. What happens in a clip depends on nothing but the clip, to the bit: not on the others, and not on the
number of processes. It is what ``unicon.tracking.Tracker`` does in lockstep, to the bit: targets are sampled
from the same buffer, past a clip's end extrapolated for 50 ms and then held.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import mujoco
import numpy as np

from unicon.control import Control, ServoControl, TorqueControl
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip import Clip
from unicon.policy import NetworkPolicy, Policy, PolicyContext, ReferenceServo
from unicon.policy_library import load_policy
from unicon.projectile import Barrage
from unicon.schedulers.dataset import at_speed
from unicon.simulation import Simulation, SimulationConfig
from unicon.state import CharacterState
from unicon.target_buffer import BufferConfig, TargetBuffer
from unicon.target_frames import TargetFrames, pack, unpack
from unicon.tracking import TICK_NS
from unicon.train.scoring.tracking_metrics import ClipScores, FrameScores, score_frames, score_run

BLOCK_TICKS = 30
"""So many ticks are judged at once."""


class KinematicPolicy(ReferenceServo):
    """No physics: the avatar is put into the target. What is not perfect then is wrong in the measure."""

    name = "kinematic"


class ZeroPolicy:
    """No torque at all: the avatar drops."""

    name = "zero"
    trained = False
    tau = 1

    def act(self, context: PolicyContext) -> TorqueControl:
        """Do nothing."""
        return TorqueControl(np.zeros_like(context.actual.joint_pos))


def find_policy(name: str) -> Policy:
    """Return a policy as ``load_policy`` does; "zero" and "kinematic" are known, too."""
    for policy in (KinematicPolicy(), ZeroPolicy()):
        if name == policy.name:
            return policy
    return load_policy(name, comparing=True)


@dataclass(frozen=True)
class Perturbation:
    """What is made harder."""

    speed: float = 1.0
    """How many times as fast the clip is played."""
    mass: float = 1.0
    """Times the mass and inertia of every body; the torques stay the same."""
    barrage: Barrage | None = None
    """What is thrown; each clip draws from its own generator, seeded by its name."""

    def __post_init__(self) -> None:
        """Raise UniconError: for a changed mass and balls together."""
        if self.barrage and self.mass != 1.0:
            raise UniconError("a perturbation has another mass or projectiles, not both")


class ClipRun(NamedTuple):
    """What happened in a clip: K ticks, fewer than it has where all was lost before."""

    ticks: int
    """Length of the clip: its frames but the first."""
    actual: CharacterState
    """``(K,)``, after each tick."""
    target: CharacterState
    """``(K,)``."""
    torque: np.ndarray
    """``(K, 35)`` [N m]."""
    contact_force: np.ndarray
    """``(K, 20)`` [N]."""
    frames: FrameScores

    def score(self) -> ClipScores:
        """Return its figures."""
        return score_run(self.ticks, self.frames, *self[1:5])


def run_clips(
    policy: Policy,
    clips: Sequence[Clip],
    perturbation: Perturbation = Perturbation(),  # noqa: B008 - frozen
    stop_when_lost: bool = True,
) -> list[ClipRun]:
    """Run clips, each once from its first frame.

    Args:
        policy: what moves the avatars.
        clips: to follow; what is returned is in their order.
        perturbation: what is made harder.
        stop_when_lost: end a run where nothing that follows can change its figures: a term is under its
            threshold, and both rules of success are broken.
    """
    runs = [_Run(slot, clip, policy, perturbation) for slot, clip in enumerate(clips)]
    going = runs
    while going := [run for run in going if not run.is_over]:
        for _ in range(BLOCK_TICKS):
            _tick(policy, [run for run in going if not run.is_over])
        _judge(going)
        if stop_when_lost:
            for run in going:
                run.stopped |= run.is_lost
    return [run.result() for run in runs]


class _Run:
    """One clip under way: after ``tick`` ticks."""

    def __init__(self, slot: int, clip: Clip, policy: Policy, perturbation: Perturbation) -> None:
        clip = at_speed(clip, perturbation.speed)
        self.barrage = perturbation.barrage
        self.simulation = _simulation(slot, perturbation.mass, self.barrage)
        self.random = np.random.default_rng(zlib.crc32(clip.name.encode()))
        self.ticks = len(clip) - 1
        self.targets = target_rows(clip, policy.tau)
        self.simulation.reset(unpack(self.targets[0]))
        self.states = np.empty((len(clip), self.targets.shape[1]))
        self.states[0] = pack(self.simulation.state)
        self.torque = np.zeros((self.ticks, len(HUMANOID.joint_names)))
        self.contact_force = np.zeros((self.ticks, len(HUMANOID.body_names)))
        self.scores: list[FrameScores] = []
        self.tick = self.judged = 0
        self.stopped = False

    @property
    def is_over(self) -> bool:
        return self.stopped or self.tick == self.ticks

    @property
    def is_lost(self) -> bool:
        return all(
            any(mask.any() for mask in masks)
            for masks in (
                [scores.lost for scores in self.scores],
                [scores.strayed for scores in self.scores],
                [scores.broken() for scores in self.scores],
            )
        )

    def step(self, control: Control) -> None:
        """Advance by a tick; a fault of the physics ends the run before it."""
        if self.barrage and self.tick and self.tick % self.barrage.every_ticks == 0:
            self.simulation.throw(self.barrage.draw(self.random))
        result = self.simulation.step(control)
        if not result.finite:
            self.stopped = True
            return
        self.torque[self.tick], self.contact_force[self.tick] = result.torque, result.contact_force
        self.tick += 1
        self.states[self.tick] = pack(self.simulation.state)

    def place(self) -> None:
        """Advance by a tick without physics."""
        self.tick += 1
        self.states[self.tick] = self.targets[self.tick]

    def result(self) -> ClipRun:
        done = slice(1, self.tick + 1)
        return ClipRun(
            ticks=self.ticks,
            actual=unpack(self.states[done]),
            target=unpack(self.targets[done]),
            torque=self.torque[: self.tick],
            contact_force=self.contact_force[: self.tick],
            frames=_join_scores(self.scores),
        )


def target_rows(clip: Clip, ahead: int) -> np.ndarray:
    """Return a clip's frames and ``ahead`` more, as the executor would have them ``(T + ahead, 83)``."""
    frames = pack(clip.frames)
    frames[:, 3:7] /= np.linalg.norm(frames[:, 3:7], axis=1, keepdims=True)
    times_ns = np.arange(len(clip) + ahead) * TICK_NS
    buffer = TargetBuffer(BufferConfig(max_frames=len(clip)))
    buffer.add(TargetFrames(clip.name, 0, times_ns[: len(clip)], unpack(frames)))
    return pack(buffer.sample(times_ns).frames)


def _tick(policy: Policy, runs: Sequence[_Run]) -> None:
    if not runs:
        return
    if isinstance(policy, KinematicPolicy):
        for run in runs:
            run.place()
        return
    control = policy.act(_look(policy, runs))
    for index, run in enumerate(runs):
        run.step(_single(control, index))


def _look(policy: Policy, runs: Sequence[_Run]) -> PolicyContext:
    """Return what the policy sees of all avatars ``(N)``."""
    ahead = np.stack([run.targets[run.tick : run.tick + policy.tau + 1] for run in runs])
    past = None
    if isinstance(policy, NetworkPolicy) and policy.card.past:
        back = np.arange(1, policy.card.past + 1)
        past = unpack(np.stack([run.states[np.maximum(run.tick - back, 0)] for run in runs]))
    actual = unpack(np.stack([run.states[run.tick] for run in runs]))
    return PolicyContext(actual, unpack(ahead[:, 1:]), unpack(ahead[:, 0]), past)


def _single(control: Control, index: int) -> Control:
    if isinstance(control, ServoControl):
        return ServoControl(control.joint_pos[index], control.joint_vel[index])
    return TorqueControl(control.torque[index])


def _judge(runs: Sequence[_Run]) -> None:
    """Score the frames that are new, of all runs at once."""
    spans = [slice(run.judged + 1, run.tick + 1) for run in runs]
    actual = np.concatenate([run.states[span] for run, span in zip(runs, spans, strict=True)])
    target = np.concatenate([run.targets[span] for run, span in zip(runs, spans, strict=True)])
    scores = score_frames(unpack(actual), unpack(target))
    first = 0
    for run, span in zip(runs, spans, strict=True):
        last = first + span.stop - span.start
        run.scores.append(_cut_scores(scores, slice(first, last)))
        run.judged, first = run.tick, last


def _cut_scores(scores: FrameScores, part: slice) -> FrameScores:
    terms = type(scores.terms)(*(term[part] for term in scores.terms))
    return FrameScores(terms, *(values[part] for values in scores[1:]))


def _join_scores(parts: Sequence[FrameScores]) -> FrameScores:
    terms = [np.concatenate(values) for values in zip(*(part.terms for part in parts), strict=True)]
    rest = [np.concatenate(values) for values in zip(*(part[1:] for part in parts), strict=True)]
    return FrameScores(type(parts[0].terms)(*terms), *rest)


@lru_cache(maxsize=64)
def _simulation(slot: int, mass: float, barrage: Barrage | None) -> Simulation:
    """Return the simulation of a place in the batch, made once in a process: it takes as long as 50 ticks."""
    if barrage:
        return Simulation(SimulationConfig(balls=barrage.balls, ball_lifetime_s=barrage.lifetime_s))
    simulation = Simulation()
    scale_mass(simulation, mass)
    return simulation


def scale_mass(simulation: Simulation, factor: float) -> None:
    """Multiply the mass and inertia of every body of the avatar; without balls."""
    if factor == 1.0:
        return
    model = simulation.model
    model.body_mass[:] *= factor
    model.body_inertia[:] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))
