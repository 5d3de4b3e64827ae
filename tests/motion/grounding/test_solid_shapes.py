"""Tests for solid_shapes.py."""

from __future__ import annotations

import mujoco
import numpy as np

from tests.motion.gaits import pose
from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.mjcf import compile_model
from unicon.motion.grounding.solid_shapes import body_height, lowest_height, lowest_point, mass_centre
from unicon.state import CharacterState


def random_states(count: int) -> CharacterState:
    random = np.random.default_rng(3)
    angles = random.uniform(HUMANOID.joint_lower, HUMANOID.joint_upper, (count, 35)) * 0.5
    quat = rotations.normalize(random.normal(size=(count, 4)))
    zeros = np.zeros((count, 3))
    return CharacterState(random.normal(size=(count, 3)), quat, zeros, zeros, angles, np.zeros_like(angles))


def test_the_rest_pose_stands_on_its_soles():
    assert np.allclose(lowest_point(pose()), 0.0, atol=1e-9)


def test_the_centre_of_mass_is_that_of_the_simulator():
    states = random_states(5)
    model = compile_model()
    data = mujoco.MjData(model)
    for k in range(5):
        data.qpos[:], data.qvel[:] = states[k].to_mujoco()
        mujoco.mj_forward(model, data)
        ours = mass_centre(forward_kinematics(states))[k]
        assert np.allclose(ours, data.subtree_com[model.body("pelvis").id], atol=1e-9)


def test_the_lowest_point_is_where_the_simulators_floor_first_touches():
    states = random_states(6)
    model = compile_model()
    data = mujoco.MjData(model)
    lowest = lowest_point(states)
    for k in range(6):
        for sunk_m, touches in ((0.001, True), (-0.001, False)):
            data.qpos[:], data.qvel[:] = states[k].to_mujoco()
            data.qpos[2] -= lowest[k] + sunk_m
            mujoco.mj_forward(model, data)
            assert (data.ncon > 0) == touches


def test_bodies_can_be_left_out():
    bodies = forward_kinematics(pose(left_ankle_y=0.5))
    assert body_height(bodies, "left_toe") < -0.05
    but = ("left_toe", "left_foot")
    assert np.allclose(lowest_height(bodies, but), 0.0, atol=1e-9)
