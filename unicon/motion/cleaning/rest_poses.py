"""Poses with the arms out that a program put before or after the take, and the jump between them and it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon.motion.cleaning.body_paths import BodyPaths

ALONG = 0.93
"""Cosine between a straight limb's two bones, and of legs to the vertical."""
OUT = 0.9
"""Cosine of how far the arms point away from each other."""
LEVEL = 0.3
"""Sine of the arms' angle to the horizontal."""
JUMP = 4.0
"""The added pose ends with a change so many times as fast as what follows ..."""
LEAST_JUMP = 15.0
"""... and at least this fast [rad/s]."""
RING_FRAMES = 10
"""A filter in the source may have smeared the jump over so many frames."""
AFTER_S = 0.3
"""How much of the take tells how fast it is."""


def arms_out(paths: BodyPaths) -> np.ndarray:
    """Return in which frames ``(T,)`` the figure stands upright with straight legs and its arms out."""
    arms = []
    straight = np.ones(len(paths.times_s), dtype=bool)
    for side in ("left", "right"):
        ends = [
            f"{side}_{part}" for part in ("upper_arm", "forearm", "hand") if f"{side}_{part}" in paths.parts
        ]
        upper, lower = (
            _unit(paths.pos(ends[1]) - paths.pos(ends[0])),
            _unit(paths.pos(ends[-1]) - paths.pos(ends[-2])),
        )
        thigh = _unit(paths.pos(f"{side}_shin") - paths.pos(f"{side}_thigh"))
        shin = _unit(paths.pos(f"{side}_foot") - paths.pos(f"{side}_shin"))
        straight &= (np.sum(upper * lower, axis=-1) > ALONG) & (-thigh[:, 2] > ALONG) & (-shin[:, 2] > ALONG)
        straight &= np.abs(upper[:, 2]) < LEVEL
        arms.append(upper)
    return straight & (-np.sum(arms[0] * arms[1], axis=-1) > OUT)


class AddedPose(NamedTuple):
    """A pose that is no part of the take."""

    frames: int
    """How many frames it takes with the jump after it; 0 where there is none."""
    turn_speed: float
    """Of the fastest joint in the jump [rad/s]."""


NO_POSE = AddedPose(0, 0.0)


def added_pose(paths: BodyPaths) -> AddedPose:
    """Return the pose with the arms out at the beginning of T frames."""
    if len(paths.times_s) < 3 or not arms_out(paths.take(slice(0, 1)))[0]:
        return NO_POSE
    posed, turn_speed = arms_out(paths), paths.turn_speeds().max(axis=1)
    if posed.all():
        return NO_POSE
    jump = int(np.argmin(posed)) - 1
    usual_frames = max(round(AFTER_S * paths.rate_hz), 4)
    after = turn_speed[jump + RING_FRAMES + 1 :][:usual_frames]
    if len(after) == 0:
        after = turn_speed[jump + 1 :]
    usual = float(np.median(after)) if len(after) else 0.0
    if turn_speed[jump] < max(JUMP * usual, LEAST_JUMP):
        return NO_POSE
    ringing = turn_speed[jump + 1 : jump + 1 + RING_FRAMES] > 2.0 * usual + 1.5
    frames = jump + 1 + (int(np.flatnonzero(ringing)[-1]) + 1 if ringing.any() else 0)
    return AddedPose(frames, float(turn_speed[jump : frames + 1].max()))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)
