"""Tests for scaled_source.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.motion.figures import REST_POSES, figure, moving
from unicon.motion.retargeting.scaled_source import scale_source
from unicon.motion.retargeting.skeletons import recognise


def test_legs_become_as_long_as_ours():
    motion = figure(moving(10), REST_POSES["arms out"])
    source = scale_source(recognise(replace(motion, offsets=0.7 * motion.offsets)))
    thigh = source.positions["left_shin"] - source.positions["left_thigh"]
    shin = source.positions["left_foot"] - source.positions["left_shin"]
    total = np.linalg.norm(thigh, axis=-1) + np.linalg.norm(shin, axis=-1)
    assert total == pytest.approx(0.845)


def test_positions_are_relative_to_the_middle_of_the_hips():
    source = scale_source(recognise(figure(moving(10), REST_POSES["arms out"])))
    assert source.positions["left_thigh"] + source.positions["right_thigh"] == pytest.approx(0.0, abs=1e-9)
    assert source.hips_w[0] == pytest.approx([0.0, 0.0, 0.92])


def test_a_missing_wrist_is_straight_on_from_the_elbow_at_rest():
    motion = figure(moving(10), REST_POSES["arms out"])
    hands = [name for name in motion.joint_names if not name.endswith("Hand")]
    keep = [motion.joint_names.index(name) for name in hands]
    place = {joint: i for i, joint in enumerate(keep)}
    bare = replace(
        motion,
        joint_names=tuple(hands),
        parents=np.array([place.get(int(motion.parents[i]), -1) for i in keep]),
        offsets=motion.offsets[keep],
        local_quat=motion.local_quat[:, keep],
    )
    whole, guessed = scale_source(recognise(motion)), scale_source(recognise(bare))
    assert np.allclose(whole.positions["left_hand"], guessed.positions["left_hand"], atol=1e-6)
