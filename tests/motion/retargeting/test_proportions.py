"""Tests for proportions.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.retargeting.proportions import resize

REST = dict(
    zip(HUMANOID.body_names, forward_kinematics(HUMANOID.rest_state()).pos_w, strict=True),
)
HIPS = 0.5 * (REST["left_thigh"] + REST["right_thigh"])


def places(rest):
    return {name: (position - HIPS)[None] for name, position in rest.items()}


def stretched(trunk: float, arm: float) -> dict[str, np.ndarray]:
    """Our rest pose with a longer trunk (from the hips up) and longer arms (from the shoulders down)."""
    longer = dict(REST)
    shoulders = 0.5 * (REST["left_upper_arm"] + REST["right_upper_arm"])
    raised = (trunk - 1.0) * (shoulders - HIPS)
    longer["head"] = HIPS + trunk * (REST["head"] - HIPS)
    for side in ("left", "right"):
        shoulder = REST[f"{side}_upper_arm"]
        for part in ("upper_arm", "forearm", "hand"):
            name = f"{side}_{part}"
            longer[name] = shoulder + raised + arm * (REST[name] - shoulder)
    return longer


def test_our_own_proportions_stay():
    same = resize(places(REST), REST)
    for name, place in places(REST).items():
        assert np.allclose(same[name], place)


@given(st.floats(0.6, 1.6), st.floats(0.6, 1.6))
def test_a_long_back_and_long_arms_become_ours(trunk, arm):
    theirs = stretched(trunk, arm)
    ours = resize(places(theirs), theirs)
    for name, place in places(REST).items():
        assert np.allclose(ours[name], place, atol=1e-9)


def test_a_hand_keeps_its_place_seen_from_the_shoulder_by_the_ratio_of_the_arms():
    theirs = stretched(1.0, 2.0)
    pose = places(theirs)
    pose["left_hand"] = pose["left_upper_arm"] + np.array([[0.6, 0.2, 0.0]])
    ours = resize(pose, theirs)
    assert ours["left_hand"] - ours["left_upper_arm"] == pytest.approx(np.array([[0.3, 0.1, 0.0]]))


def test_the_unit_of_the_rest_pose_does_not_matter():
    theirs = stretched(1.3, 0.8)
    inches = {name: position / 0.0254 for name, position in theirs.items()}
    for name, place in resize(places(theirs), theirs).items():
        assert np.allclose(resize(places(theirs), inches)[name], place)
