"""A source as fitting wants it: at 60 Hz, with our proportions, joints by the part that they play."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from unicon.motion.retargeting.alignment import Alignment, align
from unicon.motion.retargeting.limbs import LIMBS
from unicon.motion.retargeting.proportions import resize
from unicon.motion.retargeting.resampling import resample
from unicon.motion.retargeting.skeletons import load_mapping
from unicon.motion.source_motion import SourceMotion

FOREARM_SHARE = 0.26 / 0.30
"""Length of a forearm over that of an upper arm, where a source has no wrists."""


class ScaledSource(NamedTuple):
    """A source at 60 Hz with our proportions, by the parts that its mapping names."""

    positions: dict[str, np.ndarray]
    """``(T, 3)`` [m], relative to the middle of the hips."""
    turns: dict[str, np.ndarray]
    """Rotations of the joints ``(T, 4)``."""
    hips_w: np.ndarray
    """The middle of the hips ``(T, 3)`` [m], world."""
    alignment: Alignment


def scale_source(motion: SourceMotion) -> ScaledSource:
    """Return a motion, recognised before, at 60 Hz and scaled.

    Raises:
        InputFileError: when it is too short.
    """
    motion, parts = _keep_parts(motion, load_mapping(motion.family).joints)
    motion, parts = _add_wrists(resample(motion), parts)
    turns = motion.global_rotations()
    positions = motion.global_positions() * _scale(motion.rest_positions(), parts)
    by_part = {part: turns[:, joint] for part, joint in parts.items()}
    alignment = align(motion.rest_positions(), parts, positions, by_part)
    hips_w = 0.5 * (positions[:, parts["left_thigh"]] + positions[:, parts["right_thigh"]])
    places = {part: positions[:, joint] - hips_w for part, joint in parts.items()}
    places["head"] = places.pop("neck", places["head"])
    places = resize(places, {part: motion.rest_positions()[joint] for part, joint in parts.items()})
    return ScaledSource(places, by_part, hips_w, alignment)


def _keep_parts(motion: SourceMotion, joints: dict[str, str]) -> tuple[SourceMotion, dict[str, int]]:
    """Return the motion without the joints that nothing mapped hangs on, and each part's index."""
    index = {name: i for i, name in enumerate(motion.joint_names)}
    needed = {0}
    for name in joints.values():
        joint = index.get(name, 0)
        while joint > 0:
            needed.add(joint)
            joint = int(motion.parents[joint])
    keep = sorted(needed)
    place = {joint: i for i, joint in enumerate(keep)}
    kept = replace(
        motion,
        joint_names=tuple(motion.joint_names[i] for i in keep),
        parents=np.array([place.get(int(motion.parents[i]), -1) for i in keep]),
        offsets=motion.offsets[keep],
        local_quat=motion.local_quat[:, keep],
        local_pos=None if motion.local_pos is None else motion.local_pos[:, keep],
    )
    return kept, {part: place[index[name]] for part, name in joints.items() if name in index}


def _scale(rest: np.ndarray, parts: dict[str, int]) -> float:
    """Return our legs' length over the source's."""
    ours = sum(sum(limb.lengths_m) for limb in LIMBS if limb.sign > 0)
    theirs = 0.0
    for limb in LIMBS:
        if limb.sign > 0:
            hip, knee, ankle = (rest[parts[name]] for name in limb.parts)
            theirs += float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee))
    return ours / theirs


def _add_wrists(motion: SourceMotion, parts: dict[str, int]) -> tuple[SourceMotion, dict[str, int]]:
    """Return the motion with wrists where it has none: at rest straight on from the elbow."""
    for side in ("left", "right"):
        if f"{side}_hand" in parts:
            continue
        rest = motion.rest_positions()
        elbow = parts[f"{side}_forearm"]
        offset = FOREARM_SHARE * (rest[elbow] - rest[parts[f"{side}_upper_arm"]])
        still = np.tile([1.0, 0.0, 0.0, 0.0], (len(motion.times_s), 1, 1))
        local = motion.local_pos
        parts = {**parts, f"{side}_hand": len(motion.parents)}
        motion = replace(
            motion,
            joint_names=(*motion.joint_names, f"{side} wrist"),
            parents=np.append(motion.parents, elbow),
            offsets=np.vstack([motion.offsets, offset]),
            local_quat=np.concatenate([motion.local_quat, still], axis=1),
            local_pos=None if local is None else np.concatenate([local, 0 * local[:, :1] + offset], axis=1),
        )
    return motion, parts
