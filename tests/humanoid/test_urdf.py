"""Tests for urdf.py, read back by MuJoCo's own URDF reader."""

from __future__ import annotations

from xml.etree import ElementTree

import mujoco
import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.humanoid.urdf import build_urdf
from unicon.state import CharacterState


def test_mujoco_reads_it_with_all_hinges_and_the_whole_mass():
    model = mujoco.MjModel.from_xml_string(build_urdf())
    assert [model.joint(i).name for i in range(model.njnt)] == list(HUMANOID.joint_names)
    assert np.isclose(model.body_mass.sum(), 70.0 - HUMANOID.body_mass[0], atol=1e-3)
    assert np.allclose(model.jnt_range[:, 0], HUMANOID.joint_lower, atol=1e-5)


def test_its_hands_are_where_ours_are():
    model = mujoco.MjModel.from_xml_string(build_urdf())
    data = mujoco.MjData(model)
    angles = np.random.default_rng(0).uniform(-0.5, 0.5, 35)
    data.qpos[:] = angles
    mujoco.mj_kinematics(model, data)
    rest = HUMANOID.rest_state()
    state = CharacterState(**{**vars(rest), "root_pos_w": np.zeros(3), "joint_pos": angles})
    hand = forward_kinematics(state).pos_w[HUMANOID.body_names.index("left_hand")]
    assert np.allclose(data.body("left_hand").xpos, hand, atol=1e-5)


def test_every_joint_has_a_limit_and_an_effort():
    joints = ElementTree.fromstring(build_urdf()).findall("joint")
    assert len(joints) == 35
    efforts = [float(joint.find("limit").get("effort")) for joint in joints]
    assert efforts == HUMANOID.effort.tolist()
