"""How well a clip was followed: figures of one run, from the avatar's and the target's states alone.

Two kinds of failure, as the field counts them:

    S1 (PHC, UHC, ProtoMotions)   the mean over the 20 bodies of the global position error is over 0.5 m
    S3 (SONIC, BeyondMimic)       the root's height, or that of an ankle or a wrist, is off by over 0.25 m, or
                                  the vertical component of the up axis, seen from the root, by over 0.8
                                  (no unit: 0 for the same tilt, 2 for upside down)

Survival (this project, after the paper): the share of the clip before any reward term falls under 0.1. All
errors are means over the frames before the S1 failure, so that a clip that is lost early says nothing of
what follows. Frames are those after each tick; the first one, in which every run begins, does not count.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles
from unicon.reward import RewardConfig, RewardTerms, reward_terms, total_reward, tracking_errors
from unicon.state import CharacterState

S1_DISTANCE_M = 0.5
S3_HEIGHT_M = 0.25
S3_TILT = 0.8
CHATTER_HZ = 10.0
MIN_SPECTRUM_FRAMES = 12
"""Torques of fewer frames have no spectrum worth the name."""


def _indices(*parts: str) -> list[list[int]]:
    """Return the indices of parts of the body, for left and right."""
    return [[HUMANOID.body_names.index(f"{side}_{part}") for part in parts] for side in ("left", "right")]


_LIMBS = [index for side in _indices("foot", "hand") for index in side]
_FEET = _indices("foot", "toe")
_UP = np.array([0.0, 0.0, 1.0])


class FrameScores(NamedTuple):
    """Each frame by itself ``(K,)``."""

    terms: RewardTerms
    body_distance_m: np.ndarray
    """Mean over the 20 bodies of the distance from the target, global."""
    height_error_m: np.ndarray
    """Largest error of the heights of root, ankles and wrists."""
    tilt_error: np.ndarray
    """Difference of the vertical components of the up axis in the root's frame."""

    @property
    def lost(self) -> np.ndarray:
        """Where the S1 rule is broken ``(K,)``."""
        return ~(self.body_distance_m <= S1_DISTANCE_M)

    @property
    def strayed(self) -> np.ndarray:
        """Where the S3 rule is broken ``(K,)``."""
        return ~((self.height_error_m <= S3_HEIGHT_M) & (self.tilt_error <= S3_TILT))

    def broken(self, config: RewardConfig = RewardConfig()) -> np.ndarray:  # noqa: B008 - frozen
        """Return each term under its threshold ``(K, 5)``."""
        return np.asarray(~(np.stack(list(self.terms), axis=-1) >= config.threshold))


class ClipScores(NamedTuple):
    """The figures of one clip; not a number where there was nothing to measure."""

    ticks: int
    """Length of the clip: its frames but the first."""
    scored_ticks: int
    """Frames before the S1 failure: those that the errors are means of."""
    survival: float
    """Share of the clip before any reward term fell under the threshold."""
    success: float
    """1 where the S1 rule was never broken."""
    success_s3: float
    """1 where the S3 rule was never broken."""
    reward: float
    """Sum of the rewards until a term fell under the threshold, over the number of ticks: within 0..1."""
    global_mm: float
    """Mean over 20 bodies of the distance from the target."""
    root_relative_mm: float
    """Mean over 19 bodies, relative to the root, each in its own heading frame."""
    velocity_m_s: float
    """Mean over 20 bodies of the error of the velocity, by differences of positions."""
    acceleration_m_s2: float
    """Likewise of the acceleration, by second differences."""
    root_position: float
    """Mean of the reward's term, as the next four."""
    root_rotation: float
    joint_position: float
    joint_rotation: float
    joint_velocity: float
    chatter: float
    """Share of the power of the torques, in shares of the effort and without their means, above 10 Hz."""
    skate_mm_per_frame: float
    """Mean horizontal way of a foot's point of contact from frame to frame while the foot carries weight."""
    first_broken: str
    """The term that fell under the threshold first; empty where none did."""


def score_frames(actual: CharacterState, target: CharacterState) -> FrameScores:
    """Compare states ``(K,)``, each by itself."""
    ours, theirs = forward_kinematics(actual), forward_kinematics(target)
    heights = np.abs(ours.pos_w[..., [0, *_LIMBS], 2] - theirs.pos_w[..., [0, *_LIMBS], 2])
    ups = [rotations.rotate_inverse(state.root_quat_w, _UP)[..., 2] for state in (actual, target)]
    return FrameScores(
        terms=reward_terms(tracking_errors(actual, target)),
        body_distance_m=body_distances(ours, theirs).mean(axis=-1),
        height_error_m=heights.max(axis=-1),
        tilt_error=np.abs(ups[0] - ups[1]),
    )


def score_run(
    ticks: int,
    frames: FrameScores,
    actual: CharacterState,
    target: CharacterState,
    torque: np.ndarray,
    contact_force: np.ndarray,
) -> ClipScores:
    """Return the figures of a run.

    A run that ended early, after K of its ticks, is taken as lost from there on.

    Args:
        ticks: length of the clip.
        frames: the scores of the K frames that were run.
        actual: the avatar's states ``(K,)``.
        target: the target's ``(K,)``.
        torque: ``(K, 35)`` [N m].
        contact_force: on each body ``(K, 20)`` [N].
    """
    broken = frames.broken()
    survived, kept = first_true(np.any(broken, axis=-1)), first_true(frames.lost)
    complete = len(broken) == ticks
    rewards = total_reward(frames.terms)
    terms = {name: mean(values[:kept]) for name, values in frames.terms._asdict().items()}
    errors = _errors(actual[:kept], target[:kept])
    return ClipScores(
        ticks=ticks,
        scored_ticks=kept,
        survival=survived / ticks,
        success=float(complete and kept == ticks),
        success_s3=float(complete and not frames.strayed.any()),
        reward=float(np.sum(rewards[:survived]) / ticks),
        **errors,
        **terms,
        chatter=chatter(torque[:kept] / HUMANOID.effort),
        skate_mm_per_frame=skate_mm(forward_kinematics(actual[:kept]), contact_force[:kept]),
        first_broken=_first_broken(broken, survived, ticks),
    )


def first_true(mask: np.ndarray) -> int:
    """Return the index of the first true value of a mask ``(K,)``, K where there is none."""
    return int(np.argmax(mask)) if mask.any() else len(mask)


def mean(values: np.ndarray) -> float:
    """Return the mean, not a number for nothing."""
    return float(np.mean(values)) if np.size(values) else float("nan")


def body_distances(ours: BodyKinematics, theirs: BodyKinematics) -> np.ndarray:
    """Return the distance of each body from its target ``(..., 20)`` [m], global."""
    return np.linalg.norm(ours.pos_w - theirs.pos_w, axis=-1)


def root_relative_distances(actual: CharacterState, target: CharacterState) -> np.ndarray:
    """Return the distance of 19 bodies from their targets ``(..., 19)`` [m].

    Both relative to their roots, in their own heading frames.
    """
    placed = []
    for state in (actual, target):
        offset_w = forward_kinematics(state).pos_w[..., 1:, :] - state.root_pos_w[..., None, :]
        placed.append(rotations.rotate_inverse(rotations.heading(state.root_quat_w)[..., None, :], offset_w))
    return np.linalg.norm(placed[0] - placed[1], axis=-1)


def difference_errors(ours_w: np.ndarray, theirs_w: np.ndarray, order: int) -> np.ndarray:
    """Return the errors ``(K - order, B)`` of the derivative of paths ``(K, B, 3)``: m/s, m/s^2 ..."""
    return np.linalg.norm(np.diff(ours_w - theirs_w, n=order, axis=0), axis=-1) * RATE_HZ**order


def chatter(torque: np.ndarray) -> float:
    """Return the share of the power above 10 Hz of torques ``(K, J)`` at 60 Hz.

    Summed over the joints, each without its mean and under a Hann window; 0 where nothing moves, not a number
    for fewer than 12 frames.
    """
    if len(torque) < MIN_SPECTRUM_FRAMES:
        return float("nan")
    window = np.hanning(len(torque) + 2)[1:-1, None]
    power = (np.abs(np.fft.rfft((torque - torque.mean(axis=0)) * window, axis=0)) ** 2).sum(axis=1)
    fast = np.fft.rfftfreq(len(torque), 1.0 / RATE_HZ) > CHATTER_HZ
    total = power.sum()
    return float(power[fast].sum() / total) if total > 0.0 else 0.0


def skate_mm(bodies: BodyKinematics, contact_force: np.ndarray) -> float:
    """Return the mean horizontal way per frame [mm] of the feet's points of contact while they carry weight.

    Args:
        bodies: ``(K,)`` frames.
        contact_force: on each body ``(K, 20)`` [N].
    """
    if len(contact_force) < 2:
        return float("nan")
    carries = np.any(contact_force[:, _FEET] > 0.0, axis=-1)
    ways = np.linalg.norm(Soles(bodies).steps_w()[..., :2], axis=-1)
    return 1000.0 * mean(ways[carries[1:] & carries[:-1]])


def _errors(actual: CharacterState, target: CharacterState) -> dict[str, float]:
    ours, theirs = forward_kinematics(actual), forward_kinematics(target)
    return {
        "global_mm": 1000.0 * mean(body_distances(ours, theirs)),
        "root_relative_mm": 1000.0 * mean(root_relative_distances(actual, target)),
        "velocity_m_s": mean(difference_errors(ours.pos_w, theirs.pos_w, 1)),
        "acceleration_m_s2": mean(difference_errors(ours.pos_w, theirs.pos_w, 2)),
    }


def _first_broken(broken: np.ndarray, survived: int, ticks: int) -> str:
    """Return the name of the term that fell first; the physics where the run ended by itself."""
    if survived == ticks:
        return ""
    if survived == len(broken):
        return "physics"
    return RewardTerms._fields[int(np.argmax(broken[survived]))]
