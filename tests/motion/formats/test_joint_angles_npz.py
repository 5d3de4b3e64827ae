"""Tests for joint_angles_npz.py; MuJoCo's kinematics tell where some bodies are."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from unicon.errors import InputFileError
from unicon.motion.formats.joint_angles_npz import read_joint_angles
from unicon.motion.formats.motion_file import MotionFile

COORDINATES = [
    *("pelvis_tx", "pelvis_ty", "pelvis_tz", "pelvis_tilt", "pelvis_list", "pelvis_rotation"),
    *("lumbar_extension", "lumbar_bending", "lumbar_rotation"),
    *(f"{name}_{side}" for side in "rl" for name in ("hip_flexion", "hip_adduction", "hip_rotation")),
    *(f"{name}_{side}" for side in "rl" for name in ("knee_angle", "ankle_angle", "subtalar_angle")),
    *(f"{name}_{side}" for side in "rl" for name in ("mtp_angle", "arm_flex", "arm_add", "arm_rot")),
    *(f"{name}_{side}" for side in "rl" for name in ("elbow_flex", "pro_sup", "wrist_flex", "wrist_dev")),
]
INERTIA = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
MODEL = f"""
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="pelvis" pos="0 0 0.95" quat="0.7071067811865475 0.7071067811865475 0 0">{INERTIA}
      <joint name="pelvis_tx" type="slide" axis="1 0 0"/>
      <joint name="pelvis_tz" type="slide" axis="0 0 1"/>
      <joint name="pelvis_ty" type="slide" axis="0 1 0"/>
      <joint name="pelvis_tilt" axis="0 0 1"/>
      <joint name="pelvis_list" axis="1 0 0"/>
      <joint name="pelvis_rotation" axis="0 1 0"/>
      <body name="femur_l" pos="-0.056276 -0.07849 -0.07726">{INERTIA}
        <joint name="hip_flexion_l" axis="0 0 1"/>
        <joint name="hip_adduction_l" axis="1 0 0"/>
        <joint name="hip_rotation_l" axis="0 1 0"/>
        <body name="tibia_l" pos="0 -0.404425 0.001265">{INERTIA}
          <joint name="knee_angle_l" axis="0 0.0707131 -0.997497"/>
          <body name="talus_l" pos="-0.01 -0.4 0">{INERTIA}</body>
        </body>
      </body>
      <body name="torso" pos="-0.1007 0.0815 0">{INERTIA}
        <joint name="lumbar_extension" axis="0 0 1"/>
        <joint name="lumbar_bending" axis="1 0 0"/>
        <joint name="lumbar_rotation" axis="0 1 0"/>
        <body name="humerus_l" pos="0.003155 0.3715 -0.17">{INERTIA}
          <joint name="arm_flex_l" axis="0 0 1"/>
          <joint name="arm_add_l" axis="-1 0 0"/>
          <joint name="arm_rot_l" axis="0 -1 0"/>
          <body name="ulna_l" pos="0.013144 -0.286273 0.009595">{INERTIA}
            <joint name="elbow_flex_l" axis="-0.226047 -0.022269 0.973862"/>
            <body name="radius_l" pos="-0.006727 -0.013007 -0.026083">{INERTIA}</body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
"""A part of the model, in the words of MuJoCo: its left leg and arm."""


def write_angles(path, rate_hz: float = 500.0, frames: int = 40, **changes) -> MotionFile:
    """All coordinates swing; their velocities are those of the swing at this rate."""
    times_s = np.arange(frames) / rate_hz
    arrays = {}
    for number, name in enumerate(COORDINATES):
        phase = 20.0 * times_s + number
        arrays[f"q_{name}"] = 0.3 * np.sin(phase) + (0.4 if "knee" in name else 0.0)
        arrays[f"dq_{name}"] = 6.0 * np.cos(phase)
    arrays.update(changes)
    np.savez(path, **{name: value for name, value in arrays.items() if value is not None})
    return MotionFile.from_path(path)


def test_bodies_are_where_mujoco_puts_them(tmp_path):
    file = write_angles(tmp_path / "a.npz")
    motion = read_joint_angles(file)
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    angles = np.load(tmp_path / "a.npz")
    places = motion.global_positions()
    for frame in (0, 17, 39):
        for joint in range(model.njnt):
            data.qpos[joint] = angles[f"q_{model.joint(joint).name}"][frame]
        mujoco.mj_kinematics(model, data)
        for body in range(1, model.nbody):
            index = motion.joint_names.index(model.body(body).name)
            assert np.allclose(places[frame, index], data.xpos[body], atol=1e-6), model.body(body).name


def test_equal_angles_of_arms_and_knees_are_mirror_images(tmp_path):
    angles = {f"q_{name}": np.zeros(40) for name in COORDINATES}
    names = ("hip_flexion", "knee_angle", "ankle_angle", "arm_flex", "arm_add", "arm_rot", "elbow_flex")
    for name in (f"{name}_{side}" for name in names for side in "rl"):
        angles[f"q_{name}"] = np.linspace(0.1, 1.2 if "knee" in name else 0.6, 40)
    angles |= {f"d{name}": 500.0 * np.gradient(values) for name, values in angles.items()}
    motion = read_joint_angles(write_angles(tmp_path / "a.npz", **angles))
    places = dict(zip(motion.joint_names, motion.global_positions()[-1], strict=True))
    for name in ("tibia", "talus", "toes", "ulna", "hand"):
        assert np.allclose(places[f"{name}_r"] * [1, -1, 1], places[f"{name}_l"]), name
    assert places["talus_l"][0] < places["tibia_l"][0] - 0.05
    assert places["hand_l"][0] > places["ulna_l"][0]


@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 500.0])
def test_the_rate_follows_from_the_velocities(tmp_path, rate_hz):
    motion = read_joint_angles(write_angles(tmp_path / "a.npz", rate_hz))
    assert np.isclose(motion.times_s[1], 1.0 / rate_hz)
    assert (motion.name, motion.family) == ("a", "")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"q_hip_flexion_l": None}, "has no array 'q_hip_flexion_l'"),
        ({"q_arm_add_r": np.zeros(7)}, r"'q_arm_add_r' has the shape \(7,\), expected 40"),
        ({"q_knee_angle_r": np.full(40, -0.9)}, "'q_knee_angle_r' reaches -0.90 rad"),
        ({"dq_knee_angle_l": None}, "has no array 'dq_knee_angle_l'"),
    ],
)
def test_a_coordinate_that_is_not_as_it_should_be_is_named(tmp_path, changes, said):
    with pytest.raises(InputFileError, match=f"a.npz: {said}"):
        read_joint_angles(write_angles(tmp_path / "a.npz", **changes))


def test_velocities_that_do_not_fit_are_refused(tmp_path):
    changes = {f"dq_{name}": np.zeros(40) for name in COORDINATES}
    with pytest.raises(InputFileError, match="the velocities 'dq_...' don't fit the angles"):
        read_joint_angles(write_angles(tmp_path / "a.npz", **changes))


def test_a_single_frame_is_refused(tmp_path):
    with pytest.raises(InputFileError, match="has 1 frames"):
        read_joint_angles(write_angles(tmp_path / "a.npz", frames=1))
