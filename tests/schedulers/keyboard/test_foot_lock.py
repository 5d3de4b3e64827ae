"""Tests for foot_lock.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.contact import Soles
from unicon.schedulers.keyboard.foot_lock import FootLock, FootLockConfig
from unicon.state import CharacterState, move, stack

BOTH, NONE = np.ones(4), np.zeros(4)
REST = HUMANOID.rest_state()
KNEE = HUMANOID.joint_names.index("left_knee")


def crouching(shift_m: float) -> CharacterState:
    """A pose with bent knees, whose root is shifted along x: its feet slide as far."""
    joint_pos = REST.joint_pos.copy()
    for side in ("left", "right"):
        for hinge, angle in (("hip_y", -0.4), ("knee", 0.8), ("ankle_y", -0.4)):
            joint_pos[HUMANOID.joint_names.index(f"{side}_{hinge}")] = angle
    return replace(REST, joint_pos=joint_pos, root_pos_w=REST.root_pos_w + [shift_m, 0.0, -0.07])


def soles(frame: CharacterState) -> Soles:
    return Soles(forward_kinematics(stack([frame])))


def feet(frame: CharacterState) -> np.ndarray:
    both = soles(frame)
    return np.sum(both.weights[..., None] * both.points_w, axis=-2)[0, :, :2]


def test_standing_feet_stay_where_they_are_while_the_root_moves_on():
    lock = FootLock(FootLockConfig())
    frames = [lock.lock(crouching(0.004 * k), BOTH) for k in range(20)]
    assert feet(crouching(0.076))[0, 0] - feet(crouching(0.0))[0, 0] == pytest.approx(0.076)
    assert np.abs(feet(frames[-1]) - feet(frames[0])).max() < 0.006
    assert np.allclose(frames[-1].root_pos_w, crouching(0.076).root_pos_w)


def test_feet_in_the_air_are_left_alone():
    lock = FootLock(FootLockConfig())
    for k in range(10):
        frame = crouching(0.01 * k)
        assert np.allclose(lock.lock(frame, NONE).joint_pos, frame.joint_pos)


def test_a_character_that_is_moved_takes_its_held_feet_along():
    here, there = FootLock(FootLockConfig()), FootLock(FootLockConfig())
    turn, before, after = 0.7, np.array([0.2, -0.1]), np.array([-0.4, 0.3])

    def moved(frame: CharacterState) -> CharacterState:
        back, on = (np.append(place, 0.0) for place in (-before, after))
        return move(move(move(frame, np.array(0.0), back), np.array(turn), np.zeros(3)), np.array(0.0), on)

    for k in range(10):
        here.lock(crouching(0.004 * k), BOTH)
        there.lock(crouching(0.004 * k), BOTH)
    there.move(turn, before, after)
    for k in range(10, 20):
        expected = moved(here.lock(crouching(0.004 * k), BOTH))
        locked = there.lock(moved(crouching(0.004 * k)), BOTH)
        assert np.allclose(locked.joint_pos, expected.joint_pos, atol=1e-9)
        assert np.allclose(locked.root_pos_w, expected.root_pos_w)


def test_a_lifted_foot_comes_back_to_its_own_way():
    lock = FootLock(FootLockConfig())
    for k in range(15):
        lock.lock(crouching(0.004 * k), BOTH)
    off = [
        np.abs(lock.lock(crouching(0.06), NONE).joint_pos - crouching(0.06).joint_pos).max()
        for _ in range(40)
    ]
    assert off[0] > 0.02
    assert off[-1] < 1e-3
    assert np.all(np.diff(off) <= 1e-9)


def test_no_foot_is_pulled_further_than_the_limit():
    lock = FootLock(FootLockConfig(largest_m=0.05))
    for k in range(40):
        frame = lock.lock(crouching(0.01 * k), BOTH)
    assert np.abs(feet(frame) - feet(crouching(0.39))).max() < 0.055


def test_hinge_velocities_are_those_of_the_locked_legs():
    lock = FootLock(FootLockConfig())
    frames = [lock.lock(crouching(0.004 * k), BOTH) for k in range(10)]
    rate = (frames[-1].joint_pos - frames[-2].joint_pos) * 60
    assert frames[-1].joint_vel[KNEE] == pytest.approx(rate[KNEE])


def test_a_foot_that_stands_over_the_floor_is_brought_down_to_it():
    lock = FootLock(FootLockConfig())
    raised = crouching(0.0)
    raised = replace(raised, root_pos_w=raised.root_pos_w + [0.0, 0.0, 0.02])
    for _ in range(60):
        frame = lock.lock(raised, BOTH)
    assert np.abs(soles(raised).heights).min() > 0.01
    assert np.allclose(soles(frame).heights, 0.0, atol=0.003)
    assert np.allclose(frame.root_pos_w, raised.root_pos_w)


def test_the_root_sinks_no_further_than_allowed_for_a_leg_that_is_too_short():
    lock = FootLock(FootLockConfig(largest_drop_m=0.02))
    raised = replace(REST, root_pos_w=REST.root_pos_w + [0.0, 0.0, 0.1])
    frames = [lock.lock(raised, BOTH) for _ in range(60)]
    heights = np.array([frame.root_pos_w[2] for frame in frames])
    assert heights[-1] == pytest.approx(REST.root_pos_w[2] + 0.08, abs=1e-3)
    assert np.all(np.diff(heights) <= 1e-12)
    # and its velocity says so
    assert frames[5].root_lin_vel_w[2] == pytest.approx(60 * (heights[5] - heights[4]))


def test_feet_of_who_stands_on_creep_back_under_the_hips():
    lock = FootLock(FootLockConfig(creep_m_s=0.012))
    for k in range(20):
        lock.lock(crouching(0.004 * k), BOTH)
    still = crouching(0.076)
    off = [feet(lock.lock(still, BOTH))[0, 0] - feet(still)[0, 0] for _ in range(900)]
    # 1 s at 0.012 m/s
    assert off[60] - off[0] == pytest.approx(0.012, abs=0.002)
    assert off[-1] == pytest.approx(0.0, abs=0.002)
