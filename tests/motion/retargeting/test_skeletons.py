"""Tests for skeletons.py and the files in mappings/."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.motion.figures import NAMES, REST_POSES, figure, moving
from unicon import rotations
from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.motion.retargeting.rest_pose import has_standing_rest, with_rest_pose
from unicon.motion.retargeting.skeletons import REQUIRED, families, load_mapping, recognise

PARTS = {*HUMANOID.body_names, "neck", "left_hand_tip", "right_hand_tip"}


def renamed(family):
    """Our humanoid with the names of a family, as far as it has our bodies."""
    mapping = load_mapping(family)
    names, used = {}, set()
    for body in HUMANOID.body_names:
        joint = mapping.joints.get(body, f"extra {body}")
        names[body] = joint if joint not in used else f"extra {body}"
        used.add(joint)
    return figure(moving(5), REST_POSES["arms out"], names=names)


@pytest.mark.parametrize("family", families())
def test_every_family_is_recognised_by_its_names(family):
    assert recognise(renamed(family)).family == family


@pytest.mark.parametrize("family", families())
def test_mappings_name_parts_that_there_are(family):
    mapping = load_mapping(family)
    assert set(mapping.joints) <= PARTS
    assert set(REQUIRED) <= set(mapping.joints)
    lefts = {part.removeprefix("left_") for part in mapping.joints if part.startswith("left_")}
    assert lefts == {part.removeprefix("right_") for part in mapping.joints if part.startswith("right_")}
    for quat in mapping.rest.values():
        assert np.linalg.norm(quat) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("unit_m", [1.0, 0.01, 0.0254, 0.0254 / 0.45, 0.3048, 0.001])
def test_lengths_become_metres(unit_m):
    motion = recognise(figure(moving(5), unit_m=unit_m))
    knee = motion.joint_names.index("LeftLeg")
    assert np.linalg.norm(motion.offsets[knee]) == pytest.approx(0.425)
    assert motion.root_pos[0, 2] == pytest.approx(0.95)


def test_places_that_change_over_time_become_metres_too():
    motion = figure(moving(5), unit_m=0.01)
    local_pos = np.tile(motion.offsets, (5, 1, 1))
    assert np.allclose(recognise(replace(motion, local_pos=local_pos)).local_pos, local_pos * 0.01)


def test_an_unknown_skeleton_is_told_the_nearest_family_and_what_it_lacks():
    motion = figure(moving(5))
    names = tuple("Elbow" if name == "LeftForeArm" else name for name in motion.joint_names)
    with pytest.raises(InputFileError, match="nearest is 'cmu_mb', of which it lacks LeftForeArm;"):
        recognise(replace(motion, joint_names=names))


def test_a_leg_of_no_length_is_refused():
    motion = figure(moving(5))
    offsets = motion.offsets.copy()
    for name in ("LeftLeg", "LeftFoot"):
        offsets[motion.joint_names.index(name)] = 0.0
    with pytest.raises(InputFileError, match="left leg has no length"):
        recognise(replace(motion, offsets=offsets))


def test_an_unknown_family_lists_those_there_are():
    with pytest.raises(InputFileError, match="acclaim, amp_humanoid"):
        load_mapping("none")


def test_a_family_with_a_table_stands_at_rest_whatever_its_zero_pose():
    motion = renamed("bandai_namco")
    table = load_mapping("bandai_namco").rest
    axes = np.array([table.get(name, (1.0, 0.0, 0.0, 0.0)) for name in motion.joint_names], dtype=float)
    axes = rotations.normalize(axes)
    # In the file the joints' axes are those of the table: at zero angles no person stands there.
    lying = with_rest_pose(motion, rotations.conjugate(axes))
    mapping = load_mapping("bandai_namco")
    assert not has_standing_rest(lying, mapping.present(lying))
    upright = recognise(lying)
    assert has_standing_rest(upright, mapping.present(upright))
    assert np.allclose(upright.global_positions(), motion.global_positions(), atol=1e-9)


def test_names_that_fit_two_families_go_to_the_one_with_more_of_its_joints():
    motion = figure(moving(5), REST_POSES["arms out"])
    extra = load_mapping("amp_humanoid").required
    count = len(motion.joint_names)
    wider = replace(
        motion,
        joint_names=(*motion.joint_names, *extra),
        parents=np.append(motion.parents, np.zeros(len(extra), dtype=int)),
        offsets=np.vstack([motion.offsets, np.zeros((len(extra), 3))]),
        local_quat=np.concatenate([motion.local_quat, np.tile([1.0, 0, 0, 0], (5, len(extra), 1))], axis=1),
    )
    assert len(wider.joint_names) == count + len(extra)
    assert len(set(NAMES.values()) & set(load_mapping("cmu_mb").joints.values())) > len(extra)
    assert recognise(wider).family == "cmu_mb"
