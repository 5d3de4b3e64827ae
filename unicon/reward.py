"""How well the avatar follows: five terms within 0..1 and the constraint on each (paper, section 4.3).

    r_i = exp(-k_i e_i),   r = sum_i w_i r_i,   and the episode is over when any r_i < 0.1

    term             error e_i                                                             k_i   w_i
    root position    |p - p~|^2                               [m^2]                         10   0.2
    root rotation    angle(q~^-1 q)^2                         [rad^2]                        2   0.2
    joint position   mean over 19 joints of |x_j - x~_j|^2    [m^2], in the heading frame   40   0.1
    joint rotation   mean over 19 joints of angle(q~_j^-1 q_j)^2   [rad^2]                   2   0.4
    joint velocity   mean over 19 joints of |v_j - v~_j|^2    [rad^2/s^2]                  0.1   0.1

The exponents are DeepMimic's, and as in its published program the errors of the joints are averaged:
summed, a walk that is followed to its end within 4 cm would break the constraint in 40 % of its frames.
All joints count, not only the hands and feet. Joint positions are relative to the root, each in its
own heading frame, so that an error of the root is not counted twice. q_j is the rotation of a body
against its parent and v_j its relative angular velocity in the parent's frame: unlike hinge rates they
have no singularity.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from unicon import rotations
from unicon.arrays import array_namespace
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.state import CharacterState, stack

Array = Any


class RewardTerms(NamedTuple):
    """The five terms, each ``(...)`` within 0..1, 1 where the target is met exactly."""

    root_position: Array
    root_rotation: Array
    joint_position: Array
    joint_rotation: Array
    joint_velocity: Array


@dataclass(frozen=True)
class RewardConfig:
    """Weights, exponents and the constraint's threshold, in the order of ``RewardTerms``."""

    weights: tuple[float, float, float, float, float] = (0.2, 0.2, 0.1, 0.4, 0.1)
    """Share of each term in the sum; they add up to 1."""
    exponents: tuple[float, float, float, float, float] = (10.0, 2.0, 40.0, 2.0, 0.1)
    """k_i: [1/m^2], [1/rad^2], [1/m^2], [1/rad^2], [s^2/rad^2]."""
    threshold: float = 0.1
    """A term below it breaks the constraint."""


class TrackingErrors(NamedTuple):
    """The squared errors e_i ``(...)``, in the order and units of the table above."""

    root_position: Array
    root_rotation: Array
    joint_position: Array
    joint_rotation: Array
    joint_velocity: Array


def tracking_errors(actual: CharacterState, target: CharacterState) -> TrackingErrors:
    """Return the five squared errors between states ``(...)``."""
    xp = array_namespace(actual.root_pos_w)
    both = stack([actual, target])
    bodies = forward_kinematics(both)
    pos_h = _joint_positions(both, bodies)
    turn = rotations.multiply(rotations.conjugate(actual.root_quat_w), target.root_quat_w)
    quat, spin = bodies.local_quat[..., 1:, :], bodies.local_ang_vel[..., 1:, :]
    joint_turn = rotations.multiply(rotations.conjugate(quat[0, ...]), quat[1, ...])
    return TrackingErrors(
        root_position=_square(xp, target.root_pos_w - actual.root_pos_w),
        root_rotation=rotations.angle(turn) ** 2,
        joint_position=xp.mean(_square(xp, pos_h[1, ...] - pos_h[0, ...]), axis=-1),
        joint_rotation=xp.mean(rotations.angle(joint_turn) ** 2, axis=-1),
        joint_velocity=xp.mean(_square(xp, spin[1, ...] - spin[0, ...]), axis=-1),
    )


def reward_terms(
    errors: TrackingErrors,
    config: RewardConfig = RewardConfig(),  # noqa: B008 - frozen, so shared safely
) -> RewardTerms:
    """Return exp(-k_i e_i) of each error."""
    xp = array_namespace(errors.root_position)
    return RewardTerms(*(xp.exp(-k * e) for k, e in zip(config.exponents, errors, strict=True)))


def total_reward(
    terms: RewardTerms,
    config: RewardConfig = RewardConfig(),  # noqa: B008 - frozen, so shared safely
) -> Array:
    """Return the weighted sum ``(...)`` of the terms, within 0..1."""
    total = config.weights[0] * terms[0]
    for weight, term in zip(config.weights[1:], terms[1:], strict=True):
        total = total + weight * term
    return total


def breaks_constraint(
    terms: RewardTerms,
    config: RewardConfig = RewardConfig(),  # noqa: B008 - frozen, so shared safely
) -> Array:
    """Return ``(...)`` whether any term is below the threshold (not a number counts as below)."""
    xp = array_namespace(terms.root_position)
    return xp.any(~(xp.stack(list(terms), axis=-1) >= config.threshold), axis=-1)


def _joint_positions(state: CharacterState, bodies: BodyKinematics) -> Array:
    """Return where the 19 bodies but the root are ``(..., 19, 3)`` [m], in the heading frame."""
    heading = rotations.heading(state.root_quat_w)[..., None, :]
    offset_w = bodies.pos_w[..., 1:, :] - state.root_pos_w[..., None, :]
    return rotations.rotate_inverse(heading, offset_w)


def _square(xp: Any, vectors: Array) -> Array:
    return xp.sum(vectors * vectors, axis=-1)
