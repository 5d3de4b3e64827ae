"""Tests for tracking_metrics.py: each figure by hand."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import standing, swaying
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.reward import RewardTerms
from unicon.state import CharacterState, move, stack
from unicon.train.scoring.tracking_metrics import (
    FrameScores,
    chatter,
    difference_errors,
    first_true,
    score_frames,
    score_run,
    skate_mm,
)


def turned(angle_rad: float, axis: int) -> CharacterState:
    quat = np.zeros(4)
    quat[0], quat[1 + axis] = np.cos(angle_rad / 2), np.sin(angle_rad / 2)
    return CharacterState(**{**vars(standing()), "root_quat_w": quat})


def shifted(offset) -> CharacterState:
    state = standing()
    return CharacterState(**{**vars(state), "root_pos_w": state.root_pos_w + np.array(offset)})


def scored(count: int, **changes) -> FrameScores:
    ones = np.ones(count)
    values = {"body_distance_m": 0 * ones, "height_error_m": 0 * ones, "tilt_error": 0 * ones, **changes}
    return FrameScores(RewardTerms(*[ones] * 5), **values)


def run_figures(frames: FrameScores, ticks: int, actual=None, target=None, torque=None):
    count = len(frames.body_distance_m)
    target = swaying(count) if target is None else target
    actual = target if actual is None else actual
    torque = np.zeros((count, 35)) if torque is None else torque
    return score_run(ticks, frames, actual, target, torque, np.zeros((count, 20)))


def test_a_shift_is_the_distance_of_every_body_and_not_relative_to_the_root():
    target = stack([standing()] * 3)
    actual = stack([shifted([0.3, 0.4, 0.0])] * 3)
    assert np.allclose(score_frames(actual, target).body_distance_m, 0.5)
    figures = run_figures(scored(3), 3, actual, target)
    assert figures.global_mm == pytest.approx(500)
    assert figures.root_relative_mm == pytest.approx(0, abs=1e-9)
    assert figures.velocity_m_s == pytest.approx(0, abs=1e-9)


def test_the_distance_rule_is_broken_just_above_half_a_metre():
    frames = score_frames(stack([shifted([0.499, 0, 0]), shifted([0.501, 0, 0])]), stack([standing()] * 2))
    assert frames.lost.tolist() == [False, True]
    assert frames.strayed.tolist() == [False, False]


def test_the_height_rule_is_broken_just_above_a_quarter_of_a_metre():
    frames = score_frames(stack([shifted([0, 0, -0.249]), shifted([0, 0, -0.251])]), stack([standing()] * 2))
    assert frames.strayed.tolist() == [False, True]
    assert frames.lost.tolist() == [False, False]


def test_a_raised_wrist_breaks_the_height_rule():
    joint_pos = np.zeros(35)
    joint_pos[HUMANOID.joint_names.index("left_shoulder_y")] = -1.5
    raised = CharacterState(**{**vars(standing()), "joint_pos": joint_pos})
    frames = score_frames(stack([raised]), stack([standing()]))
    arm_m = np.abs(forward_kinematics(raised).pos_w - forward_kinematics(standing()).pos_w)[:, 2].max()
    assert 0.25 < frames.height_error_m[0] <= arm_m
    assert frames.strayed[0]


def test_the_tilt_is_one_minus_the_cosine_and_a_turn_on_the_spot_is_none():
    actual = stack([turned(np.pi / 2, 0), turned(1.0, 1), turned(2.0, 2)])
    tilt = score_frames(actual, stack([standing()] * 3)).tilt_error
    assert np.allclose(tilt, [1.0, 1.0 - np.cos(1.0), 0.0])


def test_survival_ends_with_the_first_term_under_its_threshold():
    terms = np.ones((5, 10))
    terms[2, 4:] = 0.09
    frames = scored(10)._replace(terms=RewardTerms(*terms))
    figures = run_figures(frames, 10)
    assert figures.survival == 0.4
    assert figures.first_broken == "joint_position"
    assert figures.reward == pytest.approx(0.4)
    assert figures.success == 1.0


def test_a_term_that_is_not_a_number_counts_as_broken():
    terms = np.ones((5, 10))
    terms[0, 3] = np.nan
    assert run_figures(scored(10)._replace(terms=RewardTerms(*terms)), 10).survival == 0.3


def test_errors_stop_before_the_clip_is_lost():
    target = stack([standing()] * 6)
    offsets = [0.1, 0.1, 0.1, 9.0, 9.0, 9.0]
    actual = stack([shifted([x, 0, 0]) for x in offsets])
    figures = run_figures(score_frames(actual, target), 6, actual, target)
    assert figures.scored_ticks == 3
    assert figures.global_mm == pytest.approx(100)
    assert (figures.success, figures.success_s3) == (0.0, 1.0)


def test_a_run_that_the_physics_ended_is_lost_from_there_on():
    figures = run_figures(scored(5), 10)
    assert (figures.survival, figures.success, figures.success_s3) == (0.5, 0.0, 0.0)
    assert figures.first_broken == "physics"


def test_nothing_scored_is_not_a_number_and_not_a_crash():
    figures = run_figures(scored(4, body_distance_m=np.full(4, 2.0)), 4)
    assert figures.scored_ticks == 0
    assert np.isnan([figures.global_mm, figures.acceleration_m_s2, figures.chatter]).all()


def test_a_steady_drift_has_a_velocity_error_and_no_acceleration_error():
    drift = np.arange(5)[:, None, None] * np.array([0.01, 0.0, 0.0])
    paths = np.zeros((5, 20, 3))
    assert np.allclose(difference_errors(paths + drift, paths, 1), 0.6)
    assert np.allclose(difference_errors(paths + drift, paths, 2), 0.0)
    growing = np.arange(5)[:, None, None] ** 2 * np.array([0.0, 0.001, 0.0])
    assert np.allclose(difference_errors(paths + growing, paths, 2), 0.002 * 3600)


def test_chatter_tells_slow_from_fast_torques():
    time_s = np.arange(120) / 60
    slow, fast = np.sin(2 * np.pi * 3 * time_s), np.sin(2 * np.pi * 20 * time_s)
    assert chatter(slow[:, None]) < 1e-3
    assert chatter(fast[:, None]) > 0.999
    assert chatter((5.0 + 2.0 * slow + fast)[:, None]) == pytest.approx(1 / 5, abs=0.01)
    assert chatter(np.full((120, 1), 7.0)) == 0.0
    assert np.isnan(chatter(slow[:11, None]))


def test_feet_skate_while_they_carry_weight_only():
    path = stack([shifted([0.002 * k, 0, 0]) for k in range(6)])
    force = np.zeros((6, 20))
    assert np.isnan(skate_mm(forward_kinematics(path), force))
    force[:, HUMANOID.body_names.index("left_toe")] = 300.0
    assert skate_mm(forward_kinematics(path), force) == pytest.approx(2.0)


def test_turning_and_shifting_the_world_changes_no_figure():
    target = swaying(20)
    actual = swaying(20, speed=0.4)

    def moved(states):
        return move(states, np.full(20, 0.7), np.tile([3.0, -2.0, 0.0], (20, 1)))

    here, there = (
        run_figures(score_frames(a, b), 20, a, b)
        for a, b in ((actual, target), (moved(actual), moved(target)))
    )
    assert here.global_mm > 10
    assert np.allclose(here[:-1], there[:-1], equal_nan=True)


def test_the_first_true_of_none_is_the_length():
    assert (first_true(np.zeros(4, bool)), first_true(np.array([0, 1, 1], bool))) == (4, 1)
