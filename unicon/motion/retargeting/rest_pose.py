"""The rest pose of a skeleton: a standing one, whatever a file's zero angles look like.

Alignment with our humanoid reads off a rest pose in which a person stands: where forward is, which way
limbs point. Most files have such a zero pose (arms out, or hanging). Others number their joints' axes
along the bones, or write whatever pose the figure was in when it was saved; for them the frames of the
joints are chosen anew.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon import rotations
from unicon.motion.retargeting.frames import unit
from unicon.motion.source_motion import SourceMotion

LEG_COSINE, KNEE_COSINE, SIDE_COSINE = 0.7, 0.8, 0.8
"""How nearly legs point away from the trunk, knees are straight, and shoulders are parallel to hips."""


def with_rest_pose(motion: SourceMotion, rest_quat_w: np.ndarray) -> SourceMotion:
    """Return the same motion, with joint frames that are parallel in another pose.

    With W the rotation ``rest_quat_w (J, 4)`` of a joint in that pose and p its parent, the new local
    rotations are W_p q W^-1 and the new offsets W_p o (W_p = 1 at the root); world positions stay the same.
    """
    parents = motion.parents
    above = np.where((parents >= 0)[:, None], rest_quat_w[parents], np.array([1.0, 0.0, 0.0, 0.0]))
    local = rotations.multiply(rotations.multiply(above, motion.local_quat), rotations.conjugate(rest_quat_w))
    local_pos = None if motion.local_pos is None else rotations.rotate(above, motion.local_pos)
    return replace(
        motion, local_quat=local, offsets=rotations.rotate(above, motion.offsets), local_pos=local_pos
    )


def has_standing_rest(motion: SourceMotion, parts: dict[str, int]) -> bool:
    """Return whether the rest pose is one that a person stands in, turned in whichever way."""
    cosines = _cosines(motion.rest_positions()[None], parts)
    return bool(
        cosines["leg"][0] > LEG_COSINE
        and cosines["knee"][0] > KNEE_COSINE
        and cosines["side"][0] > SIDE_COSINE
    )


def most_upright_frame(motion: SourceMotion, parts: dict[str, int]) -> int:
    """Return the frame that is most like standing: trunk and legs straight and vertical, no twist."""
    positions = motion.global_positions()
    cosines = _cosines(positions, parts)
    trunk = _trunk(positions, parts)
    return int(np.argmax(cosines["leg"] + cosines["knee"] + 2.0 * cosines["side"] + 3.0 * trunk[:, 2]))


def _cosines(positions: np.ndarray, parts: dict[str, int]) -> dict[str, np.ndarray]:
    """Return how straight ``(T,)`` the figure is: trunk to thighs, thighs to shins, hips to shoulders."""
    trunk = _trunk(positions, parts)
    thighs = [_bone(positions, parts, f"{side}_thigh", f"{side}_shin") for side in ("left", "right")]
    shins = [_bone(positions, parts, f"{side}_shin", f"{side}_foot") for side in ("left", "right")]
    hips = _bone(positions, parts, "right_thigh", "left_thigh")
    shoulders = _bone(positions, parts, "right_upper_arm", "left_upper_arm")
    return {
        "leg": np.minimum(*(-np.sum(thigh * trunk, axis=-1) for thigh in thighs)),
        "knee": np.minimum(*(np.sum(a * b, axis=-1) for a, b in zip(thighs, shins, strict=True))),
        "side": np.sum(hips * shoulders, axis=-1),
    }


def _trunk(positions: np.ndarray, parts: dict[str, int]) -> np.ndarray:
    hips = 0.5 * (positions[:, parts["left_thigh"]] + positions[:, parts["right_thigh"]])
    shoulders = 0.5 * (positions[:, parts["left_upper_arm"]] + positions[:, parts["right_upper_arm"]])
    return unit(shoulders - hips)


def _bone(positions: np.ndarray, parts: dict[str, int], start: str, end: str) -> np.ndarray:
    return unit(positions[:, parts[end]] - positions[:, parts[start]])
