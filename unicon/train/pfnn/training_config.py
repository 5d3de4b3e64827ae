"""Settings of the training of a phase-functioned network."""

from __future__ import annotations

from dataclasses import dataclass, field

from unicon.errors import UniconError


@dataclass(frozen=True)
class LossWeights:
    """How much each part of the output counts: the mean square of its normalised error times this."""

    root_vel_h: float = 1.0
    """Of the root along the ground; with the turn rate it is what makes the character go where it should."""
    turn_rate: float = 1.0
    """Of the heading."""
    phase_rate: float = 1.0
    """A phase that stands still stops the walk."""
    contacts: float = 0.25
    """Only the foot lock uses them."""
    path_pos_h: float = 0.5
    """Fed back by half, into the path of the next frame."""
    path_facing_h: float = 0.5
    """The same."""
    root_height: float = 0.5
    """One number that everybody sees."""
    root_rot6d_h: float = 1.0
    """Tilt of the pelvis."""
    joint_pos: float = 3.0
    """The 35 hinges together."""
    joint_vel: float = 1.0
    """Their velocities, which the next input holds."""


@dataclass(frozen=True)
class NetworkTrainingConfig:
    """What the network is and how it learns; in brackets the paper's figures (Holden et al. 2017, 5.4)."""

    minutes: float = 25.0
    """Budget of training time, judging left out [min]; 0: none."""
    steps: int = 0
    """Budget of minibatches; 0: none. With it alone a training can be repeated to the bit."""
    seed: int = 0
    """Of all that is drawn."""
    hidden: int = 256
    """Units of each of the two hidden layers (512)."""
    dropout: float = 0.3
    """Share of the pose and of the hidden units that is left out (0.3)."""
    path_dropout: float = 0.05
    """Share of the path that is left out. Less than of the rest: what is often missing is answered with an
    average, and the character would go slower or faster than asked (0.3)."""
    learning_rate: float = 1e-3
    """Of Adam at first (1e-4, constant); it falls to `learning_rate_end` along half a cosine."""
    learning_rate_end: float = 1e-5
    """At the end of the budget."""
    minibatch: int = 256
    """Samples a step, drawn at random (32)."""
    l1: float = 0.01
    """Of the mean absolute weight of each layer (0.01)."""
    pose_scale: float = 0.1
    """The normalised pose is multiplied by this, so that the path leads and the last pose follows (0.1)."""
    pose_noise: float = 0.5
    """Noise on the pose of the input, in deviations of each of its parts; what it should answer stays that of
    the clean pose, so that it learns to come back from its own errors (none)."""
    loss: LossWeights = field(default_factory=LossWeights)
    """Weights of the parts of the output."""
    judge_seconds: float = 60.0
    """Time between judgements on the held-out takes, after which all is saved [s]."""
    judge_samples: int = 10_000
    """How many samples a judgement takes at most, evenly from all."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        for name in ("hidden", "minibatch", "judge_samples"):
            if getattr(self, name) < 1:
                raise UniconError(f"training.{name} is {getattr(self, name)}, expected 1 or more")
        for name in ("minutes", "steps", "l1", "pose_noise", "learning_rate_end", "judge_seconds"):
            if getattr(self, name) < 0:
                raise UniconError(f"training.{name} is {getattr(self, name)}, expected 0 or more")
        for name in ("learning_rate", "pose_scale"):
            if getattr(self, name) <= 0:
                raise UniconError(f"training.{name} is {getattr(self, name)}, expected above 0")
        for name in ("dropout", "path_dropout"):
            if not 0 <= getattr(self, name) < 1:
                raise UniconError(f"training.{name} is {getattr(self, name)}, expected 0 to below 1")
