"""Joints that turn by half a turn within a frame or two, and most often back a little later.

Markers on a straight limb say little about its twist, and two solutions fit a bent one; so capture programs
jump between them. Where a joint comes back soon, the way between the good frames on both sides is taken:

- a thigh turns, with its shin, about the line from hip to ankle, so that the knee goes on steadily and the
  ankle stays where it is;
- any other joint is interpolated spherically.

A thigh or shin that does not come back breaks the motion; any other joint takes a few frames for its turn.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.motion.cleaning.body_paths import BodyPaths, turn_angles

FLIP_S = 1 / 30
"""Within this time ..."""
LARGEST_TURN_RAD = {
    "head": np.radians(70),
    "neck": np.radians(70),
    "chest": np.radians(70),
    "thigh": np.radians(90),
    "shin": np.radians(90),
}
"""... no person's joint turns by so much [rad] ..."""
LARGEST_OTHER_RAD = np.radians(105)
"""... and no other joint by so much: arms reach 50 rad/s."""
LARGEST_SPEED = 35.0
"""At low rates it has to be faster than this too [rad/s]."""
LONGEST_REPAIR_S = 0.8
"""What is flipped for longer cannot be made up."""
SAME_RAD = np.radians(75)
"""A joint has come back when it is this near to where it was."""
SPREAD_S = 0.05
"""How long before and after a turn that does not come back frames are wrong, or taken for a slower turn."""
LEGS = ("thigh", "shin")


class Flip(NamedTuple):
    """A joint that is not to be trusted from one frame to another."""

    part: str
    start: int
    """First frame that is wrong."""
    stop: int
    """The frame after the last wrong one."""
    turn_rad: float
    """Largest turn within a frame or two."""
    comes_back: bool

    @property
    def breaks(self) -> bool:
        """Whether nothing can be made up."""
        return not self.comes_back and self.part.endswith(LEGS)


def joint_flips(paths: BodyPaths, kept: np.ndarray) -> list[Flip]:
    """Return the flips of every part but the pelvis, in order of time, within the frames kept ``(T,)``."""
    step = max(round(FLIP_S * paths.rate_hz), 1)
    if len(paths.times_s) <= step + 1:
        return []
    angle = turn_angles(paths.local_quat, step)
    speed = angle / (paths.times_s[step:] - paths.times_s[:-step])[:, None]
    parts = {row: part for part, row in paths.parts.items() if row != paths.parts["pelvis"]}
    flips: list[Flip] = []
    for row, part in parts.items():
        limit = LARGEST_TURN_RAD.get(part.rpartition("_")[2], LARGEST_OTHER_RAD)
        fast = (angle[:, row] > limit) & (speed[:, row] > LARGEST_SPEED) & kept[:-step] & kept[step:]
        if fast.any():
            flips += _pair(part, _turns(fast, angle[:, row], step), paths, row)
    whole = (flip for flip in flips if kept[flip.start - 1 : flip.stop + 1].all())
    return sorted(whole, key=lambda flip: flip.start)


def _turns(fast: np.ndarray, angle: np.ndarray, step: int) -> list[tuple[int, int]]:
    """Return the frames before and after every turn that is too fast."""
    turns: list[tuple[int, int]] = []
    for start in np.flatnonzero(fast).tolist():
        if not turns or start >= turns[-1][1]:
            first = start + int(np.argmax(angle[start : start + step]))
            turns.append((first, first + step))
    return turns


def _pair(part: str, turns: list[tuple[int, int]], paths: BodyPaths, row: int) -> list[Flip]:
    """Join turns that follow each other to stretches that begin and end alike."""
    quat, flips = paths.local_quat[:, row], []
    longest, spread = LONGEST_REPAIR_S * paths.rate_hz, max(round(SPREAD_S * paths.rate_hz), 1)
    while turns:
        first, after = turns[0]
        back = [
            n
            for n, (_, end) in enumerate(turns)
            if n > 0 and end - first <= longest and _angle(quat, first, end) < SAME_RAD
        ]
        last = back[-1] if back else 0
        worst = max(_angle(quat, a, b) for a, b in turns[: last + 1])
        if back:
            flips.append(Flip(part, first + 1, turns[last][1], worst, True))
        else:
            middle = first + 1 + int(np.argmax(turn_angles(quat[first : after + 1])))
            start, stop = max(middle - spread, 1), min(middle + spread, len(quat) - 1)
            flips.append(Flip(part, start, stop, worst, False))
        turns = turns[last + 1 :]
    return flips


def _angle(quat: np.ndarray, a: int, b: int) -> float:
    return float(rotations.angle(rotations.multiply(rotations.conjugate(quat[a]), quat[b])))


def repair(paths: BodyPaths, parents: np.ndarray, flip: Flip, local_quat: np.ndarray) -> None:
    """Fill a flip's frames from the good ones on both sides, in the source's rotations ``(T, J, 4)``.

    Args:
        paths: of the motion before any repair.
        parents: of the source's joints ``(J,)``.
        flip: one that does not break the motion.
        local_quat: is changed.
    """
    side = flip.part.partition("_")[0]
    shin, foot = (paths.joints[paths.parts.get(f"{side}_{part}", 0)] for part in ("shin", "foot"))
    around = slice(flip.start - 1, flip.stop + 1)
    if flip.part.endswith("thigh") and parents[foot] == shin:
        _swing_knee(paths, parents, side, around, local_quat)
        return
    joint = paths.joints[paths.parts[flip.part]]
    local_quat[flip.start : flip.stop, joint] = _between(local_quat[around, joint])


def _swing_knee(
    paths: BodyPaths, parents: np.ndarray, side: str, frames: slice, local_quat: np.ndarray
) -> None:
    """Turn thigh and shin about the line from hip to ankle; the foot turns steadily from first to last."""
    thigh, shin, foot = (f"{side}_{part}" for part in ("thigh", "shin", "foot"))
    hip_w, knee_w, ankle_w = (paths.pos(part)[frames] for part in (thigh, shin, foot))
    axis = ankle_w - hip_w
    axis /= np.linalg.norm(axis, axis=-1, keepdims=True)
    bend = _across(knee_w - hip_w, axis)
    share = np.linspace(0.0, 1.0, len(axis))[:, None]
    wanted = _across((1.0 - share) * bend[0] + share * bend[-1], axis)
    sine = np.sum(np.cross(bend, wanted) * axis, axis=-1)
    swing = rotations.from_axis_angle(axis, np.arctan2(sine, np.sum(bend * wanted, axis=-1)))
    thigh_w = rotations.multiply(swing, paths.quat(thigh)[frames])
    shin_w = rotations.multiply(swing, paths.quat(shin)[frames])
    joint = paths.joints[paths.parts[thigh]]
    above_w = paths.rot_w[frames, int(np.flatnonzero(paths.joints == parents[joint])[0])]
    inner = slice(frames.start + 1, frames.stop - 1)
    local_quat[inner, joint] = rotations.multiply(rotations.conjugate(above_w), thigh_w)[1:-1]
    foot_w = _between(paths.quat(foot)[frames])
    local_quat[inner, paths.joints[paths.parts[foot]]] = rotations.multiply(
        rotations.conjugate(shin_w[1:-1]), foot_w
    )


def _between(quat: np.ndarray) -> np.ndarray:
    """Return what leads steadily from the first to the last of ``(N, 4)``, for those between."""
    share = np.linspace(0.0, 1.0, len(quat))[1:-1]
    return rotations.slerp(quat[:1], quat[-1:], share)


def _across(vectors: np.ndarray, axis: np.ndarray) -> np.ndarray:
    return vectors - axis * np.sum(vectors * axis, axis=-1, keepdims=True)
