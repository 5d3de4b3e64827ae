"""Fits a source's poses to the humanoid, in closed form and for all frames at once.

1. The motion is brought to 60 Hz and scaled so that its legs are as long as ours; what its joints do
   then is the reference.
2. Pelvis, chest, head and clavicles turn as the source's do (alignment.py); abdomen and chest share the
   trunk's bend.
3. Arms and legs go to the reference's wrists and ankles (limbs.py); feet and toes turn as the source's
   do.
4. Turns become hinge angles (euler.py), cut off at their limits; each body starts from where its parent
   really is.

Nothing is filtered in time here, so the ends of a clip are as fast as its middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.table import BODIES
from unicon.motion.clip import continuous_signs
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.retargeting.alignment import SIDEWAYS
from unicon.motion.retargeting.euler import ankle_angles, hinge_angle, hinge_angles
from unicon.motion.retargeting.frames import unit
from unicon.motion.retargeting.jumps import spread_jumps
from unicon.motion.retargeting.limbs import LIMBS, Limb, solve_limb
from unicon.motion.retargeting.scaled_source import ScaledSource, scale_source
from unicon.motion.source_motion import SourceMotion
from unicon.state import CharacterState, differentiate

_UNMEASURED = ("pelvis", "abdomen", "chest", "left_clavicle", "right_clavicle")
"""Bodies whose origin is no point that skeletons agree on."""
MOST_LEAN_RAD = 0.3
"""The trunk is never tilted by more than this to meet the source's shoulders."""
WRONG_WAY_RAD = 1.75
"""Half of the time a head is never turned by more than this against the chest."""
_INDEX = {name: i for i, name in enumerate(HUMANOID.body_names)}
_FIRST_HINGE = np.cumsum([0, *(len(body.hinges) for body in BODIES)])
_HIPS_MIDDLE = 0.5 * (HUMANOID.offsets[_INDEX["left_thigh"]] + HUMANOID.offsets[_INDEX["right_thigh"]])


@dataclass(frozen=True)
class FittedPoses:
    """A motion on our humanoid, and what it was fitted to."""

    frames: CharacterState
    """Batch ``(T,)`` at 60 Hz; the floor is where the source has it."""
    reference_pos: np.ndarray
    """The scaled source's joints ``(T, K, 3)`` [m], world axes, relative to the middle of its hips."""
    reference_bodies: tuple[str, ...]
    """The K bodies of ours whose origins should be there."""
    loop: bool
    """Whether the motion is cyclic."""


def fit_poses(motion: SourceMotion) -> FittedPoses:
    """Return the motion, recognised before, on our humanoid.

    Raises:
        InputFileError: when it is too short.
    """
    source = scale_source(motion)
    pose = _Pose(source)
    pose.fit_trunk()
    for limb in LIMBS:
        if limb.sign < 0:
            pose.fit_arm(limb)
        else:
            pose.fit_leg(limb)
    root_pos_w = source.hips_w - rotations.rotate(pose.turns["pelvis"], _HIPS_MIDDLE)
    root_quat_w = continuous_signs(pose.turns["pelvis"])
    bodies = tuple(
        name for name in HUMANOID.body_names if name in source.positions and name not in _UNMEASURED
    )
    return FittedPoses(
        frames=differentiate(root_pos_w, root_quat_w, pose.angles, RATE_HZ),
        reference_pos=np.stack([source.positions[name] for name in bodies], axis=1),
        reference_bodies=bodies,
        loop=motion.loop,
    )


class _Pose:
    """Our pose as it is fitted, from the pelvis outwards."""

    def __init__(self, source: ScaledSource) -> None:
        self.source = source
        count = len(source.hips_w)
        self.angles = np.zeros((count, len(HUMANOID.joint_names)))
        self.turns: dict[str, np.ndarray] = {}
        """World rotations ``(T, 4)`` of the bodies fitted so far, limits kept."""
        self.positions: dict[str, np.ndarray] = {}
        """Their origins ``(T, 3)`` [m], relative to the middle of the hips."""

    def fit_trunk(self) -> None:
        turns, trunk = self.source.turns, self.source.alignment.trunk
        trunk = rotations.multiply(trunk, _lean(self.source))
        pelvis, chest = rotations.multiply(turns["pelvis"], trunk), rotations.multiply(turns["chest"], trunk)
        self.turns["pelvis"] = pelvis
        self.positions["pelvis"] = -rotations.rotate(pelvis, _HIPS_MIDDLE)
        self._turn("abdomen", _halfway(pelvis, chest))
        self._turn("chest", chest)
        self._turn("head", rotations.multiply(_head_turn(turns), self.source.alignment.head))
        for side in ("left", "right"):
            joint = self.source.turns.get(f"{side}_clavicle")
            turn = self.turns["chest"] if joint is None else rotations.multiply(joint, trunk)
            self._turn(f"{side}_clavicle", turn)

    def fit_arm(self, limb: Limb) -> None:
        self._fit_limb(limb)
        hand = limb.parts[2]
        tip = self.source.positions.get(f"{hand}_tip")
        if tip is None:
            self._turn(hand, self.turns[limb.parts[1]])
            return
        along = unit(rotations.rotate_inverse(self.turns[limb.parts[1]], tip - self.source.positions[hand]))
        # Where the hand points out of the plane of its hinge the angle fades, so that it never races.
        onward = np.maximum(-along[:, 2], 0.0) + 0.5 * np.abs(along[:, 0]) + 0.1
        self._set(hand, np.arctan2(along[:, 1], onward)[:, None])

    def fit_leg(self, limb: Limb) -> None:
        self._fit_limb(limb)
        side = limb.upper.split("_")[0]
        foot = self.source.alignment.feet[side]
        self._turn(f"{side}_foot", rotations.multiply(self.source.turns[f"{side}_foot"], foot))
        joint = self.source.turns.get(f"{side}_toe")
        turn = self.turns[f"{side}_foot"]
        if joint is not None:
            bend = rotations.multiply(rotations.conjugate(self.source.turns[f"{side}_foot"]), joint)
            bend = rotations.multiply(rotations.multiply(rotations.conjugate(foot), bend), foot)
            turn = rotations.multiply(turn, bend)
        self._turn(f"{side}_toe", turn)

    def _fit_limb(self, limb: Limb) -> None:
        upper, lower, end = limb.parts
        joints = [self.source.positions[name] for name in limb.parts]
        axis = rotations.rotate(self.source.turns[upper], self.source.alignment.hinge_axes[upper])
        if limb.sign > 0:
            foot = self.source.alignment.feet[upper.split("_")[0]]
            across_foot = rotations.rotate(rotations.multiply(self.source.turns[end], foot), SIDEWAYS)
            agreement = np.maximum(np.sum(axis * across_foot, axis=-1, keepdims=True), 0.0)
            axis = unit(axis + agreement * agreement * across_foot)
        origin = self._origin(upper)
        fitted = solve_limb(limb, origin, joints, axis)
        self._turn(upper, fitted.upper_quat_w)
        self._set(lower, fitted.hinge[:, None])

    def _origin(self, body: str) -> np.ndarray:
        parent = BODIES[_INDEX[body]].parent
        assert parent is not None
        arm = rotations.rotate(self.turns[parent], HUMANOID.offsets[_INDEX[body]])
        return self.positions[parent] + arm

    def _turn(self, body: str, turn_w: np.ndarray) -> None:
        """Turn a body towards a world rotation ``(T, 4)``."""
        parent = BODIES[_INDEX[body]].parent
        assert parent is not None
        local = rotations.multiply(rotations.conjugate(self.turns[parent]), turn_w)
        self._set(body, _angles_of(body, local))

    def _set(self, body: str, angles: np.ndarray) -> None:
        """Give a body's hinges their angles ``(T, n)``, within limits, and place it."""
        spec = BODIES[_INDEX[body]]
        assert spec.parent is not None
        hinges = _hinges(body)
        angles = spread_jumps(np.clip(angles, HUMANOID.joint_lower[hinges], HUMANOID.joint_upper[hinges]))
        self.angles[:, hinges] = angles
        self.positions[body] = self._origin(body)
        turn = self.turns[spec.parent]
        for column, hinge in enumerate(spec.hinges):
            turn = rotations.multiply(
                turn, rotations.from_axis_angle(np.array(hinge.axis), angles[:, column])
            )
        self.turns[body] = turn


def _halfway(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the turns ``(T, 4)`` halfway from one to the other."""
    return rotations.slerp(a, b, np.full(len(a), 0.5))


def _head_turn(turns: dict[str, np.ndarray]) -> np.ndarray:
    """Return the head's turns ``(T, 4)``; the neck's where a file has the head the wrong way round."""
    against_chest = rotations.angle(rotations.multiply(rotations.conjugate(turns["chest"]), turns["head"]))
    return turns["neck"] if "neck" in turns and np.median(against_chest) > WRONG_WAY_RAD else turns["head"]


def _lean(source: ScaledSource) -> np.ndarray:
    """Return the turn ``(4,)`` about y that brings our shoulders nearest to where the source's are.

    Seen from the pelvis, in the mean over the motion; skeletons differ in how the trunk stands over the hips.
    """
    pelvis, chest = (
        rotations.multiply(source.turns[part], source.alignment.trunk) for part in ("pelvis", "chest")
    )
    theirs = 0.5 * (source.positions["left_upper_arm"] + source.positions["right_upper_arm"])
    lower, middle, upper = (HUMANOID.offsets[_INDEX[name]] for name in ("abdomen", "chest", "left_clavicle"))
    ours = rotations.rotate(pelvis, lower - _HIPS_MIDDLE) + rotations.rotate(_halfway(pelvis, chest), middle)
    ours = ours + rotations.rotate(chest, upper * np.array([1.0, 0.0, 1.0]))
    a, b = rotations.rotate_inverse(pelvis, ours), rotations.rotate_inverse(pelvis, theirs)
    sine, cosine = np.sum(a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]), np.sum(a[:, [0, 2]] * b[:, [0, 2]])
    angle = np.clip(np.arctan2(sine, cosine), -MOST_LEAN_RAD, MOST_LEAN_RAD)
    return rotations.from_axis_angle(SIDEWAYS, angle)


def _hinges(body: str) -> slice:
    """Return the columns of a body's hinges."""
    return slice(_FIRST_HINGE[_INDEX[body]], _FIRST_HINGE[_INDEX[body] + 1])


def _angles_of(body: str, local: np.ndarray) -> np.ndarray:
    """Return a body's hinge angles ``(T, n)`` for its turns ``(T, 4)`` against its parent."""
    axes = [int(np.argmax(hinge.axis)) for hinge in BODIES[_INDEX[body]].hinges]
    if len(axes) == 1:
        return hinge_angle(local, axes[0])[:, None]
    if axes == [1, 0]:
        return ankle_angles(local)
    hinges = _hinges(body)
    order = "".join("XYZ"[axis] for axis in axes)
    limits = HUMANOID.joint_lower[hinges], HUMANOID.joint_upper[hinges]
    return hinge_angles(local, order, *limits, may_spin=body.endswith(("upper_arm", "thigh")))
