"""Recognises a skeleton by the names of its joints, and brings its lengths to metres.

Every family of skeletons has one file in ``mappings/``: which joint plays which part of ours, and, where
a file's zero pose is no pose that a person could stand in, how the joints lie in one that is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from unicon import rotations
from unicon.errors import InputFileError
from unicon.motion.retargeting.rest_pose import has_standing_rest, most_upright_frame, with_rest_pose
from unicon.motion.source_motion import SourceMotion

MAPPINGS = Path(__file__).parent / "mappings"

UNITS_M = (1.0, 0.01, 0.0254, 0.0254 / 0.45, 0.3048, 0.001)
"""Metre, centimetre, inch, CMU's unit, foot, millimetre."""
LEG_M = 0.8
"""About how long a person's leg is from hip to ankle; tells the unit of length."""

_SIDED = ("upper_arm", "forearm", "thigh", "shin", "foot")
REQUIRED = ("pelvis", "chest", "head", *(f"{side}_{part}" for side in ("left", "right") for part in _SIDED))
"""Parts without which there is no fitting."""


@dataclass(frozen=True)
class Mapping:
    """Which joint of a skeleton family plays which part of ours."""

    family: str
    joints: dict[str, str]
    """Joint by part. Parts are our bodies, and ``neck`` (where the head's turn begins), ``left_hand_tip``,
    ``right_hand_tip`` (any joint beyond the wrist)."""
    rest: dict[str, tuple[float, ...]]
    """How joints lie in a standing pose: quaternions against the world; empty where zero angles stand."""

    @property
    def required(self) -> list[str]:
        """The joints that a skeleton of this family must have."""
        return [joint for part, joint in self.joints.items() if part in REQUIRED]

    def present(self, motion: SourceMotion) -> dict[str, int]:
        """Return the index of each part's joint, for the parts that the motion has."""
        index = {name: i for i, name in enumerate(motion.joint_names)}
        return {part: index[joint] for part, joint in self.joints.items() if joint in index}


@cache
def load_mapping(family: str) -> Mapping:
    """Return the mapping of a skeleton family.

    Raises:
        InputFileError: when there is none; the message lists those there are.
    """
    path = MAPPINGS / f"{family}.yaml"
    if not path.exists():
        raise InputFileError(
            f"{path}: there is no mapping for skeletons {family!r}; there are {', '.join(families())}"
        )
    content: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    rest = {joint: tuple(quat) for joint, quat in content.get("rest", {}).items()}
    return Mapping(family, content["joints"], rest)


@cache
def families() -> tuple[str, ...]:
    """Return the names of all skeleton families, in alphabetical order."""
    return tuple(sorted(path.stem for path in MAPPINGS.glob("*.yaml")))


def recognise(motion: SourceMotion) -> SourceMotion:
    """Return the motion in metres, with its family, at rest in a standing pose.

    The family is the one whose mapping has the most of its joints in the motion. The unit of length is the
    one that makes a leg nearest to 0.8 m.

    Raises:
        InputFileError: when no family fits; the message names the nearest and what the motion lacks.
    """
    mapping = _find_mapping(motion)
    parts = mapping.present(motion)
    unit_m = _find_unit(motion, parts)
    local_pos = None if motion.local_pos is None else motion.local_pos * unit_m
    motion = replace(
        motion,
        family=mapping.family,
        offsets=motion.offsets * unit_m,
        root_pos=motion.root_pos * unit_m,
        local_pos=local_pos,
    )
    return _stand_at_rest(motion, mapping, parts)


def _find_mapping(motion: SourceMotion) -> Mapping:
    names = set(motion.joint_names)
    mappings = [load_mapping(family) for family in families()]
    fitting = [mapping for mapping in mappings if names.issuperset(mapping.required)]
    if fitting:
        return max(fitting, key=lambda mapping: len(names.intersection(mapping.joints.values())))
    nearest = max(mappings, key=lambda mapping: len(names & set(mapping.required)) / len(mapping.required))
    missing = [joint for joint in nearest.required if joint not in names]
    raise InputFileError(
        f"{motion.name}: its skeleton is of no known family; the nearest is {nearest.family!r}, of which it "
        f"lacks {', '.join(missing[:8])}{' ...' if len(missing) > 8 else ''}; write a mapping for it in "
        f"{MAPPINGS}"
    )


def _find_unit(motion: SourceMotion, parts: dict[str, int]) -> float:
    def length(joint: int, above: int) -> float:
        total = 0.0
        while joint not in (above, -1):
            total += float(np.linalg.norm(motion.offsets[joint]))
            joint = int(motion.parents[joint])
        return total

    leg = length(parts["left_foot"], parts["left_thigh"])
    if not leg > 0:
        raise InputFileError(f"{motion.name}: its left leg has no length, so its unit of length is unknown")
    return min(UNITS_M, key=lambda unit: abs(np.log(leg * unit / LEG_M)))


def _stand_at_rest(motion: SourceMotion, mapping: Mapping, parts: dict[str, int]) -> SourceMotion:
    """Choose the joints' frames so that the rest pose is one that a person stands in."""
    if mapping.rest:
        return with_rest_pose(motion, _tabled_rest(motion, mapping))
    if has_standing_rest(motion, parts):
        return motion
    frame = most_upright_frame(motion, parts)
    return with_rest_pose(motion, motion.global_rotations()[frame])


def _tabled_rest(motion: SourceMotion, mapping: Mapping) -> np.ndarray:
    """Return the rotations ``(J, 4)`` of the joints in the standing pose of the mapping's table."""
    turns = np.zeros((len(motion.parents), 4))
    for joint, (name, parent) in enumerate(zip(motion.joint_names, motion.parents, strict=True)):
        if name in mapping.rest:
            turns[joint] = rotations.normalize(np.array(mapping.rest[name]))
        else:
            turns[joint] = turns[parent] if parent >= 0 else (1.0, 0.0, 0.0, 0.0)
    return turns
