"""Tests for synthesis.py and cycles.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.pfnn.walking_samples import walker
from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.contact import Soles
from unicon.train.pfnn.cycles import find_cycle, loop
from unicon.train.pfnn.synthesis import UPPER, bend, calm_upper, plant, reverse, sequence


def test_a_bent_walk_turns_at_the_rate_and_keeps_its_speed_along_its_facing():
    frames = walker("walk", 4.0, speed=1.2).frames
    bent = bend(frames, 0.5)
    heading = np.unwrap(rotations.heading_angle(bent.root_quat_w))
    assert heading[-1] == pytest.approx(4.0 * 0.5, rel=1e-3)
    assert np.allclose(np.linalg.norm(bent.root_lin_vel_w[:, :2], axis=-1), 1.2, atol=1e-3)
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    assert np.sum(bent.root_lin_vel_w[:, :2] * ahead, axis=-1).min() > 1.19


def test_who_stands_is_not_turned():
    bent = bend(walker("stand", 2.0, speed=0.0, step=0.0).frames, 1.0)
    assert np.allclose(rotations.heading_angle(bent.root_quat_w), 0.0)


def test_a_reversed_walk_goes_backward():
    frames = walker("walk", 2.0).frames
    back = reverse(frames)
    assert np.allclose(back.root_lin_vel_w[:, 0], -1.0, atol=1e-9)
    assert np.array_equal(back.joint_pos[0], frames.joint_pos[-1])


def test_calming_leaves_the_legs_alone():
    frames = walker("walk", 1.0).frames
    pose = np.full(35, 0.1)
    calm = calm_upper(frames, pose)
    assert np.allclose(calm.joint_pos[:, UPPER], 0.1)
    assert np.array_equal(calm.joint_pos[:, ~UPPER], frames.joint_pos[:, ~UPPER])
    assert {HUMANOID.joint_names[i].split("_")[-2] for i in np.flatnonzero(~UPPER)} >= {"hip", "ankle"}


def test_a_sequence_goes_on_where_its_parts_end():
    stand = walker("stand", 1.0, speed=0.0, step=0.0).frames
    path = sequence((stand, walker("walk", 3.0, heading=2.0).frames, stand), [0.6, 0.6])
    assert path.batch_shape == (61 + 181 + 61,)
    steps = np.linalg.norm(np.diff(path.root_pos_w, axis=0), axis=-1) * 60
    assert steps.max() < 1.1
    assert np.allclose(path.root_pos_w[:, 1], 0.0, atol=1e-6)


def test_planted_feet_rest_where_they_stand():
    planted = plant(sequence([walker("walk", 4.0, speed=0.7).frames], []))
    slips = Soles(forward_kinematics(planted.frames)).steps_w()[..., :2]
    both = planted.contact[1:] & planted.contact[:-1]
    assert both.mean() > 0.1
    assert np.median(np.linalg.norm(slips, axis=-1)[both]) < 2e-3


def test_the_cycle_of_a_walk_is_found_and_repeated():
    frames = walker("walk", 1.7).frames
    first, last = find_cycle(frames) or (0, 0)
    assert last - first == pytest.approx(60, abs=1)
    longer = loop(frames, 5.0)
    assert longer is not None
    assert longer.batch_shape[0] >= 300
    assert longer.root_pos_w[-1, 0] == pytest.approx(longer.batch_shape[0] / 60, abs=0.05)


def test_a_motion_shorter_than_a_cycle_has_none():
    assert find_cycle(walker("walk", 0.4).frames) is None
