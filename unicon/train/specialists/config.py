"""Settings of a training by specialists."""

from __future__ import annotations

from dataclasses import dataclass, field

from unicon.errors import UniconError
from unicon.train.learning.networks import NetworkConfig

Points = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class DistillationConfig:
    """How the student learns from its teachers."""

    teacher_until: float = 0.4
    """Share of the time in which some episodes are still acted by the teacher: all at first, then fewer."""
    noise: float = 0.05
    """Deviation of the noise on all actions, so that both see states off the path [shares of torque]."""
    learning_rate: float = 1e-3
    """Adam's at the beginning."""
    learning_rate_end: float = 3e-5
    """And at the end; a cosine in between."""
    minibatch: int = 1024
    """Samples of a gradient step."""
    updates_a_step: int = 4
    """Gradient steps for each control step of all environments."""
    replay_mb: int = 1024
    """Memory for samples; the oldest are overwritten when it is full [MiB, about 1,100 samples each]."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        if not 0.0 <= self.teacher_until <= 1.0:
            raise UniconError("specialists.distillation: expected teacher_until within 0..1")
        if min(self.noise, self.learning_rate, self.learning_rate_end) <= 0.0:
            raise UniconError("specialists.distillation: expected noise and learning rates above 0")
        if min(self.minibatch, self.updates_a_step, self.replay_mb) < 1:
            raise UniconError(
                "specialists.distillation: expected minibatch, updates_a_step, replay_mb of 1 or more"
            )


@dataclass(frozen=True)
class SpecialistsConfig:
    """Stages of a training by specialists.

    What stands in the rest of the recipe holds for the specialists; what is otherwise in the other stages is
    said here. ``run.minutes`` is the budget of a round: minutes of training, summed over the processes that
    train at the same time. The stages get shares of it.
    """

    rounds: int = 1
    """How many rounds of specialists and distillation; clips that are new in the library begin one more."""
    jobs: int = 0
    """How many specialists train at the same time, a core each; 0: one a core."""
    max_clips: int = 12
    """A cluster has at most so many clips."""
    min_clips: int = 3
    """Classes with fewer are put together with their neighbours in the class tree."""

    generalist_share: float = 0.15
    """Of the budget; goes to the clusters in later rounds."""
    clusters_share: float = 0.4
    """Of the budget, for all clusters; the worse the generalist follows a clip the more its cluster gets."""
    singles_share: float = 0.25
    """Of the budget, and what clusters left over, for specialists of single clips that still fail."""
    distillation_share: float = 0.2
    """Of the budget."""
    finetuning_share: float = 0.0
    """Of the budget, for PPO with the student's networks at the end; 0: none."""

    single_minutes: float = 1.5
    """A specialist of a single clip gets at least so much; those nearest to success come first [min]."""
    check_seconds: float = 20.0
    """Between looks whether a specialist masters its clips, which ends its training [s]."""
    noisy_starts: int = 5
    """Runs from noisy starts that have to succeed for each clip, at 30 and at 60 Hz."""

    generalist_points: Points = ((0.0, 0.16), (1.0, 0.10))
    """Schedule of the generalist's noise, as ``variance.points``."""
    finetuning_points: Points = ((0.0, 0.05), (1.0, 0.04))
    """Schedule of the noise in the last stage."""
    student: NetworkConfig = field(
        default_factory=lambda: NetworkConfig(actor_sizes=(512, 512), critic_sizes=(256, 256))
    )
    """The student's networks."""
    distillation: DistillationConfig = field(default_factory=DistillationConfig)
    """How it learns."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        for wrong, expected in (
            (
                min(self.rounds, self.noisy_starts) < 1 or self.jobs < 0,
                "rounds and noisy_starts of 1 or more",
            ),
            (not 1 <= self.min_clips <= self.max_clips, "min_clips from 1 to max_clips"),
            (min(self.shares) < 0, "shares of 0 or more"),
            (not min(self.shares[:2]) > 0 or not self.distillation_share > 0, "a share of each stage"),
            (self.single_minutes <= 0 or self.check_seconds <= 0, "times above 0"),
        ):
            if wrong:
                raise UniconError(f"specialists: expected {expected}")

    @property
    def shares(self) -> tuple[float, float, float, float, float]:
        """Of generalist, clusters, singles, distillation and fine-tuning, in whatever unit."""
        return (
            self.generalist_share,
            self.clusters_share,
            self.singles_share,
            self.distillation_share,
            self.finetuning_share,
        )
