"""Settings of the tracking environment."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from unicon.errors import UniconError
from unicon.motion.clip_index import RATE_HZ
from unicon.reward import RewardConfig
from unicon.train.environment.action_modes import ActionMode
from unicon.train.environment.observation_variants import parse_variant

Five = tuple[float, float, float, float, float]


@dataclass(frozen=True)
class EnvironmentConfig:
    """What the policy learns in. Frames are those of the clips, 1/60 s each, at every control rate."""

    simulator: Literal["batch", "mujoco"] = "batch"
    """batch: compiled, for training; mujoco: the reference, and what batch falls back to."""
    num_envs: int = 1024
    """How many avatars learn at once."""
    threads: int = 0
    """Threads of the simulation; 0: one a processor that this process may use."""
    seed: int = 0
    """Of the draws of starts and their noise."""

    control_hz: Literal[30, 60] = 30
    """Decisions a second. 30 halves the cost; every score is taken at 60."""
    substeps: int = 4
    """Physics steps in 1/60 s: 4 is the executor's 240 Hz, 2 is coarser and cheaper."""
    constraint_solves: int = 6
    """Of the batch simulator: at most as often a physics step finds out which contacts push."""

    action: ActionMode = "pd"
    """What the policy's 35 outputs do; see action_modes.py."""
    observation: str = "tau-1"
    """What the policy sees: tau-k, lookahead-k, stack-k or frames-a-b-c; see observation_variants.py."""
    stride: int = 1
    """Frames between the targets it sees, and from the present to the first, at 30 Hz and at 60 Hz control
    alike. With 1 the first is 1/60 s ahead, as it is for the executor."""

    reward: RewardConfig = field(default_factory=RewardConfig)
    """Weights and exponents of the terms, and the constraint's threshold."""
    constraint: bool = True
    """An episode ends when a term is below its threshold; without it only clip, time and faults end it."""
    thresholds: Five | None = None
    """Thresholds of the five terms, where they differ; none: the reward's for each."""
    grace_s: float = 1.0 / 3.0
    """After a start, which may be up to 10 frames off, only ``grace_threshold`` ends an episode [s]."""
    grace_threshold: float = 0.02
    """Threshold of every term in that time, where it is lower than the usual one."""
    loosening_steps: int = 0
    """Control steps of each environment over which the thresholds rise linearly from ``grace_threshold``
    to their full value, so that the first policies are not cut off at once; 0: full from the start."""
    episode_s: float = 10.0
    """An episode that goes on for so long is truncated [s]."""

    balancer: bool = True
    """Clips are drawn evenly over the class tree; without it every frame of the data is as likely."""
    failure_cap: float = 4.0
    """How much likelier a start is before a section that always fails than before one that never does;
    1: failures change nothing."""

    rsis_share: float = 0.5
    """Share of starts in the state of another frame than the target's (reactive state initialisation)."""
    rsis_frames: tuple[int, int] = (5, 10)
    """Least and greatest distance of that frame, before or after."""
    position_noise_m: float = 0.04
    """Every start is shifted by up to so much along x and y [m]."""
    height_noise_m: float = 0.01
    """And lifted by up to so much, never lowered into the floor [m]."""
    joint_noise_rad: float = 0.08
    """And each hinge turned by up to so much [rad]."""
    velocity_noise: float = 0.25
    """And each of its velocities v changed by up to so much times min(1, 0.3 + |v|) [m/s, rad/s]."""

    mirror_share: float = 0.5
    """Share of episodes in which left and right are exchanged; 0 for a library that holds mirrored copies."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        parse_variant(self.observation, self.stride)
        low, high = self.rsis_frames
        for wrong, message in (
            (
                self.num_envs < 1 or self.threads < 0 or self.seed < 0,
                "num_envs of 1 or more, no negative seed",
            ),
            (self.control_hz not in (30, 60), "control_hz of 30 or 60"),
            (self.substeps < 1 or self.constraint_solves < 1, "substeps and constraint_solves of 1 or more"),
            (not 1 <= low <= high, "rsis_frames such as (5, 10)"),
            (not 0 <= self.rsis_share <= 1 or not 0 <= self.mirror_share <= 1, "shares within 0..1"),
            (self.failure_cap < 1, "failure_cap of 1 or more"),
            (min(self.noises) < 0, "noises that are not negative"),
            (self.episode_s <= 0 or self.grace_s < 0 or self.loosening_steps < 0, "times above 0"),
        ):
            if wrong:
                raise UniconError(f"environment: expected {message}")

    @property
    def frame_step(self) -> int:
        """Frames in a control step."""
        return round(RATE_HZ / self.control_hz)

    @property
    def noises(self) -> tuple[float, float, float, float]:
        """The four noises of a start: position, height, joints, velocities."""
        return self.position_noise_m, self.height_noise_m, self.joint_noise_rad, self.velocity_noise
