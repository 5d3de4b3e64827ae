"""Tests for mjcf.py: what MuJoCo makes of the table."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import SERVO_GROUP, compile_model


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return compile_model()


def test_mujocos_order_is_the_tables_order(model):
    assert [model.body(i + 1).name for i in range(20)] == list(HUMANOID.body_names)
    assert [model.joint(i + 1).name for i in range(35)] == list(HUMANOID.joint_names)
    assert (model.nq, model.nv, model.nu) == (42, 41, 70)


def test_masses_and_limits_are_the_tables(model):
    assert np.allclose(model.body_mass[1:], HUMANOID.body_mass)
    assert np.allclose(model.jnt_range[1:, 0], HUMANOID.joint_lower)
    assert np.allclose(model.jnt_range[1:, 1], HUMANOID.joint_upper)
    assert np.allclose(model.actuator_ctrlrange[:35, 1], HUMANOID.effort)
    assert np.allclose(model.actuator_forcerange[35:, 1], HUMANOID.effort)
    assert np.allclose(model.dof_damping[6:], HUMANOID.damping)


def test_physics_runs_at_240_hertz_with_friction_one_and_no_memory(model):
    assert np.isclose(model.opt.timestep, 1 / 240)
    assert np.all(model.geom_friction[:, 0] == 1.0)
    assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_WARMSTART
    assert model.opt.disableactuator == 1 << SERVO_GROUP


def test_it_stands_one_metre_eighty_tall_on_its_soles(model):
    data = mujoco.MjData(model)
    data.qpos[:], _ = HUMANOID.rest_state().to_mujoco()
    mujoco.mj_kinematics(model, data)
    heights = []
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] == 0 or not model.geom_conaffinity[geom]:
            continue
        axes = np.abs(data.geom_xmat[geom].reshape(3, 3)[2])
        size = model.geom_size[geom]
        kind = model.geom_type[geom]
        if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
            reach = size[0] + axes[2] * size[1]
        elif kind == mujoco.mjtGeom.mjGEOM_BOX:
            reach = axes @ size
        else:
            reach = np.linalg.norm(axes * size)
        heights.append((data.geom_xpos[geom, 2] - reach, data.geom_xpos[geom, 2] + reach))
    assert np.isclose(min(low for low, _ in heights), 0.0, atol=1e-6)
    assert np.isclose(max(high for _, high in heights), 1.8, atol=1e-6)


def test_only_the_floor_is_touched(model):
    body = model.geom_bodyid != 0
    assert not model.geom_contype[body].any()
    assert model.geom_contype[~body].tolist() == [1]
