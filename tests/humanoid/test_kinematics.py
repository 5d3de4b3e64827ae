"""Tests for kinematics.py, against MuJoCo's own."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
import torch

from tests.test_state import random_state
from unicon import rotations
from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.mjcf import compile_model
from unicon.state import CharacterState


@pytest.mark.parametrize("seed", range(5))
def test_bodies_are_where_mujoco_puts_them_and_as_fast(seed):
    model = compile_model()
    data = mujoco.MjData(model)
    state = random_state(seed)
    data.qpos[:], data.qvel[:] = state.to_mujoco()
    mujoco.mj_forward(model, data)
    bodies = forward_kinematics(state)
    assert np.allclose(bodies.pos_w, data.xpos[1:21], atol=1e-9)
    assert np.allclose(bodies.rot_w.reshape(20, 9), data.xmat[1:21], atol=1e-9)
    assert np.allclose(np.abs(np.sum(bodies.quat_w * data.xquat[1:21], axis=-1)), 1.0)
    for index in range(20):
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, index + 1, velocity, 0)
        assert np.allclose(bodies.ang_vel_w[index], velocity[:3], atol=1e-9)
        assert np.allclose(bodies.lin_vel_w[index], velocity[3:], atol=1e-9)


def test_local_rotations_and_spins_chain_to_the_world_ones():
    bodies = forward_kinematics(random_state(9))
    from unicon.humanoid import HUMANOID

    for body, parent in list(enumerate(HUMANOID.parents))[1:]:
        local = rotations.to_matrix(bodies.local_quat[body])
        assert np.allclose(bodies.rot_w[body], bodies.rot_w[parent] @ local)
        spin = bodies.rot_w[parent] @ bodies.local_ang_vel[body]
        assert np.allclose(bodies.ang_vel_w[body], bodies.ang_vel_w[parent] + spin)


def test_batches_and_torch_give_the_same():
    states = random_state(3, 2, 4)
    batch = forward_kinematics(states)
    assert batch.pos_w.shape == (2, 4, 20, 3)
    assert np.allclose(batch.lin_vel_w[1, 2], forward_kinematics(states[1, 2]).lin_vel_w)
    torched = CharacterState(*(torch.from_numpy(v) for v in vars(states).values()))
    assert np.allclose(forward_kinematics(torched).pos_w.numpy(), batch.pos_w)
