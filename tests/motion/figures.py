"""Sources whose right result is known: our own humanoid's motions on skeletons of other conventions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.retargeting.rest_pose import with_rest_pose
from unicon.motion.source_motion import SourceMotion
from unicon.state import CharacterState, differentiate

NAMES = {
    **{"pelvis": "Hips", "abdomen": "Spine", "chest": "Spine1", "head": "Head"},
    **{
        f"{side}_{body}": side.capitalize() + joint
        for side in ("left", "right")
        for body, joint in (
            *(("clavicle", "Shoulder"), ("upper_arm", "Arm"), ("forearm", "ForeArm"), ("hand", "Hand")),
            *(("thigh", "UpLeg"), ("shin", "Leg"), ("foot", "Foot"), ("toe", "ToeBase")),
        )
    },
}
"""Our bodies by the names of the family cmu_mb."""


def hinge(name: str) -> int:
    return HUMANOID.joint_names.index(name)


def pose(**angles: float) -> np.ndarray:
    """The zero pose but for some hinges [rad]; of names without a side both sides, mirrored."""
    joint_pos = np.zeros(35)
    for name, angle in angles.items():
        if name in HUMANOID.joint_names:
            joint_pos[hinge(name)] = angle
            continue
        joint_pos[hinge(f"left_{name}")] = angle
        joint_pos[hinge(f"right_{name}")] = angle * HUMANOID.mirror_sign[hinge(f"right_{name}")]
    return joint_pos


REST_POSES = {
    "hanging": pose(),
    "arms out": pose(shoulder_x=np.pi / 2),
    "arms half out": pose(shoulder_x=0.7),
    "legs spread": pose(shoulder_x=np.pi / 2, hip_x=0.35),
}


def moving(
    count: int = 90, rate_hz: float = 60.0, speed: float = 1.2, straight: bool = False
) -> CharacterState:
    """A walk-like motion that begins in the zero pose and turns most hinges."""
    t = np.arange(count) / rate_hz
    swing, bend = np.sin(2 * np.pi * t), 0.5 - 0.5 * np.cos(2 * np.pi * t)
    joint_pos = np.zeros((count, 35))
    for name, path in {
        **{
            "left_hip_y": -0.5 * swing,
            "right_hip_y": 0.5 * swing,
            "left_knee": 0.9 * bend,
            "right_knee": bend,
        },
        **{"left_shoulder_y": 0.6 * swing, "right_shoulder_y": -0.6 * swing, "left_shoulder_x": 0.5 * bend},
        **{"left_elbow": -1.2 * bend, "right_elbow": -0.9 * bend, "left_hip_x": 0.2 * bend},
        **{
            "abdomen_z": 0.1 * swing,
            "chest_z": 0.1 * swing,
            "head_y": 0.3 * bend,
            "left_ankle_y": 0.3 * swing,
        },
        **{"left_clavicle": 0.2 * bend, "right_toe": -0.4 * bend, "right_hip_z": -0.2 * bend},
    }.items():
        joint_pos[:, hinge(name)] = path
    if straight:
        joint_pos[
            :, [hinge(f"{side}_{name}") for side in ("left", "right") for name in ("knee", "elbow")]
        ] = 0.0
    return path_of(joint_pos, rate_hz, speed)


def path_of(joint_pos: np.ndarray, rate_hz: float = 60.0, speed: float = 0.0) -> CharacterState:
    """Poses ``(T, 35)`` on a root that moves on."""
    count = len(joint_pos)
    root_pos = np.stack([speed * np.arange(count) / rate_hz, np.zeros(count), np.full(count, 0.95)], axis=-1)
    return differentiate(root_pos, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)), joint_pos, rate_hz)


def figure(
    state: CharacterState,
    rest: np.ndarray | None = None,
    unit_m: float = 1.0,
    turn: np.ndarray | None = None,
    rate_hz: float = 60.0,
    names: dict[str, str] | None = None,
) -> SourceMotion:
    """Our humanoid as a source at rest in the pose ``rest``, all its frames turned by ``turn``."""
    names = names or NAMES
    bodies = [HUMANOID.body_names.index(name) for name in names]
    kinematics = forward_kinematics(state)
    place = {body: i for i, body in enumerate(bodies)}
    parents = np.array([place.get(int(HUMANOID.parents[body]), -1) for body in bodies])
    offsets = HUMANOID.offsets[bodies] / unit_m
    offsets[0] = 0.0
    local = kinematics.local_quat[:, bodies].copy()
    local[:, 0] = state.root_quat_w
    motion = SourceMotion(
        name="figure",
        family="",
        joint_names=tuple(names.values()),
        parents=parents,
        offsets=offsets,
        times_s=np.arange(len(local)) / rate_hz,
        root_pos=state.root_pos_w / unit_m,
        local_quat=local,
    )
    frame = path_of(np.tile(np.zeros(35) if rest is None else rest, (2, 1)))
    rest_quat = forward_kinematics(frame).quat_w[0, bodies]
    if turn is not None:
        rest_quat = rotations.multiply(turn, rest_quat)
    return with_rest_pose(motion, rest_quat)


def turned(motion: SourceMotion, heading_rad: float) -> SourceMotion:
    """The whole motion turned about the vertical."""
    turn = rotations.from_heading(np.array(heading_rad))
    local = motion.local_quat.copy()
    local[:, 0] = rotations.multiply(turn, local[:, 0])
    return replace(motion, root_pos=rotations.rotate(turn, motion.root_pos), local_quat=local)
