"""The executor's core: one control tick from targets to policy to torque to physics to report.

A tick at time t looks up the targets at t + 1/60 (t + 2/60 ...), asks the policy for a control from the
avatar's state at t, and advances the physics; then avatar and target stand at t + 1/60. Whatever decides
comes in through `offer`, `apply` and `tick`, and times are those of ticks: no clock is read here, so the
same calls give the same results to the bit, live or from a recording.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import asdict, dataclass
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

import numpy as np

from unicon.commands import Command, LoadPolicy, Reset, SelectSource, ThrowProjectile
from unicon.control import Control, ServoControl
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.policy import Policy, PolicyContext
from unicon.policy_library import load_policy
from unicon.reward import (
    RewardConfig,
    RewardTerms,
    breaks_constraint,
    reward_terms,
    tracking_errors,
)
from unicon.simulation import CONTROL_HZ, Simulation, StepResult
from unicon.state import CharacterState, hold
from unicon.target_frames import (
    NS_PER_S,
    RawTargetFrames,
    RejectedTargetsError,
    RejectReason,
    TargetLimits,
    check,
    pack,
)
from unicon.target_sources import SourcesConfig, TargetSources

TICK_NS = NS_PER_S // CONTROL_HZ
HISTORY_TICKS = CONTROL_HZ


class Mode(IntEnum):
    """What the executor is doing; the numbers are those of the messages."""

    WAITING = 0
    FOLLOWING = 1
    HOLDING = 2
    FALLEN = 3
    PAUSED = 4


@dataclass(frozen=True)
class TrackerConfig:
    """How an avatar follows and what becomes of a fall."""

    policy: str = "reference_servo"
    """Name or folder of the policy to begin with."""
    source: str = ""
    """Source to follow; empty for whichever began last."""
    reset_after_s: float = 2.0
    """How long after a fall the avatar is put into its target; negative: never, it tries to go on."""
    fall_height_m: float = 0.35
    """How far the pelvis may be below the target's."""
    fall_after_s: float = 1.0
    """How long the pelvis must be too low, or a reward term under its threshold, to count as fallen."""
    recover_after_s: float = 0.5
    """How long all must be well again for a fall to be over."""
    dump_dir: str = ""
    """Folder for the last second of states when the physics fails; empty for none."""


class CommandResult(NamedTuple):
    """What became of a command."""

    success: bool
    message: str


class TickReport(NamedTuple):
    """All about one tick."""

    time_ns: int
    """When it began; `actual` and `target` hold 1/60 s later."""
    tick: int
    episode: int
    mode: Mode
    source: str
    actual: CharacterState
    target: CharacterState
    torque: np.ndarray
    """``(35,)`` [N m]."""
    contact_force: np.ndarray
    """``(20,)`` [N]."""
    reward_terms: RewardTerms
    accepted: tuple[tuple[str, int], ...]
    """Source and sequence of each target message taken in since the tick before."""
    notices: tuple[str, ...]
    """What a person should be told."""


class Tracker:
    """One avatar that follows targets.

    Raises:
        UniconError: when the policy of the configuration cannot be loaded.
    """

    def __init__(self, config: TrackerConfig = TrackerConfig()) -> None:  # noqa: B008 - frozen
        self.config = config
        self.simulation = Simulation()
        self.policy: Policy = load_policy(config.policy)
        self.sources = TargetSources(SourcesConfig())
        self.sources.selected = config.source
        self.rejected: Counter[RejectReason] = Counter()
        self.ticks = self.episode = self.falls = self.faults = 0
        self._limits, self._reward = TargetLimits(), RewardConfig()
        self._accepted: list[tuple[str, int]] = []
        self._notices: list[str] = []
        self._last_time_ns: int | None = None
        self._fault_tick: int | None = None
        self._history: deque[tuple[np.ndarray, np.ndarray]] = deque(maxlen=HISTORY_TICKS)
        self._rest = HUMANOID.rest_state()
        self._start_over(self._rest)

    def offer(self, raw: RawTargetFrames) -> RejectReason | None:
        """Take in a target message, or count it as refused and return the reason.

        Before the first tick there is no time yet: a message counts as heard when its frames begin.
        """
        try:
            targets = check(raw, self._last_time_ns, self._limits)
            first_ns = int(targets.times_ns[0])
            self.sources.offer(targets, first_ns if self._last_time_ns is None else self._last_time_ns)
        except RejectedTargetsError as error:
            self.rejected[error.reason] += 1
            return error.reason
        self._accepted.append((targets.source, targets.sequence))
        return None

    def apply(self, command: Command) -> CommandResult:
        """Carry out a command before the coming tick; a refusal changes nothing."""
        try:
            return CommandResult(True, self._carry_out(command))
        except UniconError as error:
            return CommandResult(False, str(error))

    def tick(self, time_ns: int) -> TickReport:
        """Advance by 1/60 s from ``time_ns``."""
        self._last_time_ns = time_ns
        before = self.simulation.state
        targets = self._targets(time_ns, before)
        control = self._control(before, targets)
        result = self.simulation.step(control)
        self._history.append((pack(before), _pack_control(control)))
        if not result.finite:
            self._recover_from_fault(before)
        actual, target = self.simulation.state, self._present_target(targets)
        terms = reward_terms(tracking_errors(actual, target), self._reward)
        self._judge(actual, target, terms)
        report = self._report(time_ns, actual, target, result, terms)
        self.ticks += 1
        self._reset_when_due()
        return report

    def go_on_from(self, last_time_ns: int, ticks: int, episode: int) -> None:
        """Count on as if ``ticks`` ticks had been done already, the last of them at ``last_time_ns``."""
        self._last_time_ns, self.ticks, self.episode = last_time_ns, ticks, episode

    def live_sources(self) -> list[str]:
        """Return the sources that were heard within the last half second."""
        return self.sources.live(self._last_time_ns or 0)

    def _targets(self, time_ns: int, avatar: CharacterState) -> CharacterState | None:
        ahead = np.arange(1, self.policy.tau + 1) * TICK_NS
        return self.sources.sample(time_ns + ahead, time_ns, avatar)

    def _control(self, avatar: CharacterState, targets: CharacterState | None) -> Control:
        """Ask the policy; before the first target the reference servo holds the rest pose."""
        if targets is None:
            return ServoControl(self._rest.joint_pos, self._rest.joint_vel)
        return self.policy.act(PolicyContext(avatar, targets))

    def _present_target(self, targets: CharacterState | None) -> CharacterState:
        self._target = self._rest if targets is None else targets[0]
        self.sources.remember(self._target)
        return self._target

    def _judge(self, actual: CharacterState, target: CharacterState, terms: RewardTerms) -> None:
        """Decide on the mode, and whether this tick is the one in which the avatar counts as fallen."""
        low = actual.root_pos_w[2] < target.root_pos_w[2] - self.config.fall_height_m
        bad = bool(low or breaks_constraint(terms, self._reward))
        self._bad_ticks = self._bad_ticks + 1 if bad else 0
        self._good_ticks = 0 if bad else self._good_ticks + 1
        if self._fallen_ticks is not None:
            self._fallen_ticks += 1
            if self._good_ticks >= self.config.recover_after_s * CONTROL_HZ:
                self._fallen_ticks = None
                self._notices.append("on its feet again")
        elif self._bad_ticks >= self.config.fall_after_s * CONTROL_HZ:
            self._fallen_ticks = 0
            self.falls += 1
            self._notices.append("fallen: too far from the target for too long")
        self.mode = self._present_mode()

    def _present_mode(self) -> Mode:
        if self._fallen_ticks is not None:
            return Mode.FALLEN
        if not self.sources.source:
            return Mode.WAITING
        live = self.sources.is_live(self._last_time_ns or 0)
        return Mode.FOLLOWING if live else Mode.HOLDING

    def _reset_when_due(self) -> None:
        wait_s = self.config.reset_after_s
        if self._fallen_ticks is None or wait_s < 0:
            return
        if self._fallen_ticks >= wait_s * CONTROL_HZ:
            self._start_over(self._target)
            self.episode += 1
            self._notices.append("reset to the target after a fall")

    def _start_over(self, state: CharacterState) -> None:
        self.simulation.reset(state)
        self.mode = Mode.WAITING
        self._target = state
        self._bad_ticks = self._good_ticks = 0
        self._fallen_ticks: int | None = None

    def _recover_from_fault(self, before: CharacterState) -> None:
        self.faults += 1
        self.episode += 1
        again = self._fault_tick is not None and self._fault_tick == self.ticks - 1
        self._fault_tick = self.ticks
        # A state that fails at once would fail for ever, so the second time it is left for the rest pose.
        self._start_over(self._rest if again else hold(before))
        dumped = "" if again else self._dump()
        place = "the rest pose" if again else "the last good state"
        self._notices.append(f"the physics failed: went back to {place}{dumped}")

    def _dump(self) -> str:
        if not self.config.dump_dir:
            return ""
        folder = Path(self.config.dump_dir)
        path = folder / f"fault_tick{self.ticks}.npz"
        states, controls = zip(*self._history, strict=True)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            np.savez(path, states=np.stack(states), controls=np.stack(controls))
        except OSError as error:
            return f"; {path} could not be written ({error.strerror})"
        return f"; the last second is in {path}"

    def _carry_out(self, command: Command) -> str:
        match command:
            case Reset(to="rest"):
                selected, self.sources = self.sources.selected, TargetSources(SourcesConfig())
                self.sources.selected = selected
                self._accepted = []
                self._fault_tick = None
                self._start_over(self._rest)
                self.episode += 1
                return "stands in its rest pose; all targets are forgotten"
            case Reset():
                if not self.sources.source:
                    raise UniconError("there is no target to reset to; publish target frames first")
                self._start_over(self._target)
                self.episode += 1
                return "stands in the present target"
            case SelectSource(source=source):
                if len(source) > self._limits.max_source_length:
                    raise UniconError(
                        f"a source's name has at most {self._limits.max_source_length} characters"
                    )
                self.sources.selected = source
                return f"follows {source!r}" if source else "follows whichever source began last"
            case LoadPolicy(policy=name):
                self.policy = load_policy(name)
                return f"runs {self.policy.name}"
            case ThrowProjectile(projectile=projectile):
                self.simulation.throw(projectile)
                thrown = f"{projectile.mass_kg:g} kg at {projectile.speed_m_s:g} m/s"
                return f"threw {thrown} at the {projectile.body}"

    def _report(
        self,
        time_ns: int,
        actual: CharacterState,
        target: CharacterState,
        result: StepResult,
        terms: RewardTerms,
    ) -> TickReport:
        accepted, notices = tuple(self._accepted), tuple(self._notices)
        self._accepted, self._notices = [], []
        return TickReport(
            time_ns=time_ns,
            tick=self.ticks,
            episode=self.episode,
            mode=self.mode,
            source=self.sources.source,
            actual=actual,
            target=target,
            torque=result.torque,
            contact_force=result.contact_force,
            reward_terms=terms,
            accepted=accepted,
            notices=notices,
        )


def config_to_dict(config: TrackerConfig) -> dict[str, object]:
    """Return a configuration as it is recorded."""
    return asdict(config)


def _pack_control(control: Control) -> np.ndarray:
    """Return a control as ``(70,)``: a servo's positions and velocities, or torques and NaN."""
    if isinstance(control, ServoControl):
        return np.concatenate([control.joint_pos, control.joint_vel])
    return np.concatenate([control.torque, np.full(len(control.torque), np.nan)])
