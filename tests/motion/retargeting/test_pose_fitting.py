"""Tests for pose_fitting.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.motion.figures import NAMES, REST_POSES, figure, hinge, moving, path_of, pose, turned
from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.retargeting.pose_fitting import fit_poses
from unicon.motion.retargeting.rest_pose import with_rest_pose
from unicon.motion.retargeting.skeletons import recognise

EXACT_RAD = 0.03


def fitted(motion):
    return fit_poses(recognise(motion))


@pytest.mark.parametrize("rest", REST_POSES)
def test_our_own_motion_comes_back_whatever_the_rest_pose(rest):
    state = moving()
    result = fitted(figure(state, REST_POSES[rest]))
    assert np.abs(result.frames.joint_pos - state.joint_pos).max() < EXACT_RAD
    assert np.allclose(result.frames.root_pos_w, state.root_pos_w, atol=0.002)


@pytest.mark.parametrize("unit_m", [0.01, 0.0254 / 0.45, 0.0254, 0.001])
def test_the_unit_of_length_does_not_matter(unit_m):
    state = moving()
    result = fitted(figure(state, REST_POSES["arms out"], unit_m=unit_m))
    assert np.abs(result.frames.joint_pos - state.joint_pos).max() < EXACT_RAD
    assert np.allclose(result.frames.root_pos_w, state.root_pos_w, atol=0.002)


def test_a_smaller_figure_is_scaled_to_our_legs():
    state = moving()
    motion = figure(state, REST_POSES["arms out"])
    small = replace(motion, offsets=0.8 * motion.offsets, root_pos=0.8 * motion.root_pos)
    result = fitted(small)
    assert np.abs(result.frames.joint_pos - state.joint_pos).max() < EXACT_RAD
    assert np.allclose(result.frames.root_lin_vel_w[5:-5, 0], 1.2, atol=0.02)


@settings(max_examples=10, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.3))
def test_axes_that_are_turned_at_rest_change_nothing(turn):
    """As in files whose offsets have z up although the motion has y up."""
    state = moving(30)
    straight = fitted(figure(state, REST_POSES["arms out"]))
    result = fitted(
        figure(state, REST_POSES["arms out"], turn=rotations.normalize(np.array(turn, dtype=float)))
    )
    assert np.allclose(result.frames.joint_pos, straight.frames.joint_pos, atol=1e-6)
    assert np.allclose(result.reference_pos, straight.reference_pos, atol=1e-9)


@settings(max_examples=10, deadline=None)
@given(st.floats(-3, 3))
def test_turning_the_whole_motion_turns_the_root_alone(heading):
    motion = figure(moving(30), REST_POSES["arms out"])
    straight, result = fitted(motion), fitted(turned(motion, heading))
    assert np.allclose(result.frames.joint_pos, straight.frames.joint_pos, atol=1e-6)
    turn = rotations.from_heading(np.array(heading))
    expected = rotations.multiply(turn, straight.frames.root_quat_w)
    assert np.allclose(np.abs(np.sum(expected * result.frames.root_quat_w, axis=-1)), 1.0)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 1000))
def test_joint_frames_of_any_axes_change_nothing_where_the_motion_shows_a_standing_pose(seed):
    """As in files whose axes go along the bones: at zero angles they show no person."""
    state = moving(60)
    motion = figure(state)
    axes = rotations.normalize(np.random.default_rng(seed).normal(size=(len(NAMES), 4)))
    result = fitted(with_rest_pose(motion, axes))
    assert np.abs(result.frames.joint_pos - state.joint_pos).max() < EXACT_RAD


def test_the_reference_is_where_our_own_bodies_were():
    state = moving()
    result = fitted(figure(state, REST_POSES["arms out"]))
    pos_w = forward_kinematics(state).pos_w
    hips = [HUMANOID.body_names.index(f"{side}_thigh") for side in ("left", "right")]
    expected = pos_w - pos_w[:, hips].mean(axis=1, keepdims=True)
    chosen = [HUMANOID.body_names.index(name) for name in result.reference_bodies]
    assert len(chosen) == 15
    assert np.allclose(result.reference_pos, expected[:, chosen], atol=1e-6)


def test_knees_bend_backwards_and_elbows_forwards():
    frames = fitted(figure(moving(), REST_POSES["legs spread"])).frames
    for side in ("left", "right"):
        assert frames.joint_pos[:, hinge(f"{side}_knee")].max() > 0.8
        assert frames.joint_pos[:, hinge(f"{side}_elbow")].min() < -0.8
        assert frames.joint_pos[:, hinge(f"{side}_knee")].min() > -0.01


def test_straight_limbs_stay_straight_on_other_proportions():
    motion = figure(moving(straight=True), REST_POSES["arms out"])
    longer = motion.offsets.copy()
    for name, factor in (("LeftLeg", 1.1), ("RightFoot", 0.9), ("LeftForeArm", 1.2), ("RightHand", 0.8)):
        longer[motion.joint_names.index(name)] *= factor
    frames = fitted(replace(motion, offsets=longer)).frames
    for name in ("left_knee", "right_knee", "left_elbow", "right_elbow"):
        assert np.abs(frames.joint_pos[:, hinge(name)]).max() < 0.05


def test_hands_go_where_the_sources_are_on_other_proportions():
    motion = figure(path_of(np.tile(pose(elbow=-1.6, shoulder_y=-0.5), (30, 1))), REST_POSES["arms out"])
    shorter = motion.offsets.copy()
    for name in ("LeftArm", "RightArm"):
        shorter[motion.joint_names.index(name)] *= 0.8
    result = fitted(replace(motion, offsets=shorter))
    pos_w = forward_kinematics(result.frames).pos_w
    hips = [HUMANOID.body_names.index(f"{side}_thigh") for side in ("left", "right")]
    ours = pos_w - pos_w[:, hips].mean(axis=1, keepdims=True)
    for name in ("left_hand", "right_hand"):
        error = (
            ours[:, HUMANOID.body_names.index(name)]
            - result.reference_pos[:, result.reference_bodies.index(name)]
        )
        assert np.linalg.norm(error, axis=-1).max() < 0.015


def test_an_arm_that_passes_through_straight_never_flips():
    count = 120
    bend = -1.5 * np.abs(np.cos(np.pi * np.arange(count) / (count - 1)))
    joint_pos = np.tile(pose(shoulder_x=0.8), (count, 1))
    joint_pos[:, hinge("left_elbow")] = bend
    rng = np.random.default_rng(0)
    motion = figure(path_of(joint_pos), REST_POSES["arms out"])
    noisy = rotations.multiply(
        motion.local_quat,
        rotations.from_rotation_vector(0.003 * rng.normal(size=(*motion.local_quat.shape[:2], 3))),
    )
    frames = fitted(replace(motion, local_quat=noisy)).frames
    arm = [hinge(f"left_shoulder_{axis}") for axis in "xzy"]
    assert np.abs(frames.joint_pos[:, arm] - joint_pos[:, arm]).max() < 0.1
    assert np.abs(np.diff(frames.joint_pos[:, arm], axis=0)).max() * 60 < 4.0


def test_hinges_are_no_faster_than_the_bodies_by_much():
    """An arm out to the side with the forearm up is where its three hinges are singular."""
    count = 120
    joint_pos = np.tile(pose(shoulder_x=np.pi / 2, elbow=-1.5), (count, 1))
    joint_pos[:, hinge("left_shoulder_z")] = np.linspace(1.2, 1.8, count)
    joint_pos[:, hinge("left_shoulder_x")] += 0.2 * np.sin(np.linspace(0, 12, count))
    joint_pos[:, hinge("right_shoulder_z")] = -np.pi / 2
    result = fitted(figure(path_of(joint_pos), REST_POSES["arms out"]))
    kinematics = forward_kinematics(result.frames)
    fastest = np.linalg.norm(kinematics.ang_vel_w, axis=-1).max()
    assert np.abs(result.frames.joint_vel).max() < 3.0 * fastest + 1.0
    expected = forward_kinematics(path_of(joint_pos))
    assert (
        np.abs(kinematics.pos_w - kinematics.pos_w[:, :1] - expected.pos_w + expected.pos_w[:, :1]).max()
        < 0.03
    )


def test_limits_are_kept():
    state = path_of(np.tile(pose(knee=2.0, elbow=-2.5, ankle_y=1.3, head_y=1.2), (30, 1)))
    bent = figure(state, REST_POSES["arms out"])
    spin = rotations.from_rotation_vector(np.array([0.0, 0.8, 0.0]))
    local = rotations.multiply(bent.local_quat, spin)
    local[:, 0] = bent.local_quat[:, 0]
    angles = fitted(replace(bent, local_quat=local)).frames.joint_pos
    assert np.all(angles >= HUMANOID.joint_lower - 1e-12)
    assert np.all(angles <= HUMANOID.joint_upper + 1e-12)


@pytest.mark.parametrize("rate_hz", [24.0, 30.0, 60.0, 100.0, 120.0])
def test_a_clip_begins_and_ends_as_fast_as_it_goes_on(rate_hz):
    motion = figure(moving(int(rate_hz), rate_hz), REST_POSES["arms out"], rate_hz=rate_hz)
    speed = np.linalg.norm(fitted(motion).frames.root_lin_vel_w, axis=-1)
    assert np.allclose(speed, 1.2, rtol=0.02)
    assert abs(speed[0] - speed[5]) < 0.02 * speed[5]


def test_a_source_without_wrists_collarbones_and_toes_is_fitted_too():
    state = moving()
    names = {body: name for body, name in NAMES.items() if not body.endswith(("hand", "toe", "clavicle"))}
    motion = figure(state, REST_POSES["hanging"])
    keep = [motion.joint_names.index(name) for name in names.values()]
    place = {joint: i for i, joint in enumerate(keep)}
    chest = motion.joint_names.index("Spine1")
    parents = [place.get(int(motion.parents[joint]), place[chest]) for joint in keep]
    offsets, local = motion.offsets.copy(), motion.local_quat.copy()
    for side in ("Left", "Right"):
        arm, shoulder = (motion.joint_names.index(f"{side}{name}") for name in ("Arm", "Shoulder"))
        offsets[arm] += offsets[shoulder]
        local[:, arm] = rotations.multiply(local[:, shoulder], local[:, arm])
    result = fitted(
        replace(
            motion,
            joint_names=tuple(names.values()),
            parents=np.array([-1, *parents[1:]]),
            offsets=offsets[keep],
            local_quat=local[:, keep],
        )
    )
    knees = [hinge("left_knee"), hinge("right_knee")]
    assert np.abs(result.frames.joint_pos[:, knees] - state.joint_pos[:, knees]).max() < EXACT_RAD
    elbows = [hinge("left_elbow"), hinge("right_elbow")]
    assert np.abs(result.frames.joint_pos[:, elbows] - state.joint_pos[:, elbows]).max() < 0.15


def test_a_head_that_a_file_has_the_wrong_way_round_follows_the_neck():
    state = moving()
    motion = figure(state, REST_POSES["arms out"])
    names = (*motion.joint_names[:3], "Neck1", *motion.joint_names[3:])
    head = 3
    parents = np.where(motion.parents >= head, motion.parents + 1, motion.parents)
    flip = np.tile([0.0, 1.0, 0.0, 0.0], (len(state.root_pos_w), 1))
    local = np.insert(motion.local_quat, head + 1, flip, axis=1)
    result = fitted(
        replace(
            motion,
            joint_names=names,
            parents=np.insert(parents, head + 1, head),
            offsets=np.insert(motion.offsets, head + 1, [0.0, 0.0, 0.1], axis=0),
            local_quat=local,
        )
    )
    heads = [hinge(f"head_{axis}") for axis in "xyz"]
    assert np.abs(result.frames.joint_pos[:, heads] - state.joint_pos[:, heads]).max() < EXACT_RAD


def test_whether_it_is_cyclic_is_kept():
    assert fitted(replace(figure(moving(10)), loop=True)).loop
