"""Tests for drive_metrics.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.motion.gaits import pose, walk
from unicon import rotations, state
from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.drive import Stage
from unicon.schedulers.keyboard.drive_metrics import SETTLE_S, DriveResult, measure_drive
from unicon.state import CharacterState, differentiate

SECONDS = 5.0
FRAMES = round(SECONDS * 60)


def measure(frames: CharacterState, *commands: LocomotionCommand, first_s: float = 0.0) -> DriveResult:
    return measure_drive(frames, [Stage("stage", SECONDS, command) for command in commands], first_s)


def turning(rate: float, speed: float) -> CharacterState:
    """Face along a circle and go along it."""
    heading = rate * np.arange(FRAMES) / 60
    steps = speed / 60 * np.stack([np.cos(heading), np.sin(heading), np.zeros(FRAMES)], axis=-1)
    base = pose(FRAMES, 0.1)
    return replace(
        base,
        root_pos_w=base.root_pos_w + np.cumsum(steps, axis=0),
        root_quat_w=rotations.from_heading(heading),
    )


def test_who_walks_as_told_makes_no_error():
    result = measure(walk(FRAMES, speed=1.2).frames, LocomotionCommand((1.2, 0.0)))
    assert result.velocity_error_percent == pytest.approx(0.0, abs=1e-6)
    assert result.heading_error_deg == pytest.approx(0.0, abs=1e-6)
    assert np.isnan(result.slide_standing_cm_s)


def test_planted_feet_slide_only_as_they_touch_and_lift_and_a_root_that_outruns_them_drags_them():
    frames = walk(FRAMES, speed=1.0).frames
    dragged = frames.root_pos_w + np.outer(np.arange(FRAMES) * 0.3 / 60, [1.0, 0.0, 0.0])
    command = LocomotionCommand((1.0, 0.0))
    assert measure(frames, command).slide_moving_cm_s < 6.0
    assert measure(replace(frames, root_pos_w=dragged), command).slide_moving_cm_s > 25.0


def test_errors_by_hand():
    # 1.0 m/s instead of 1.2 forward and none of 0.5 to the left: |(-0.2, -0.5)| / |(1.2, 0.5)| = 0.5385 / 1.3
    result = measure(walk(FRAMES, speed=1.0).frames, LocomotionCommand((1.2, 0.5)))
    assert result.stages[0].achieved_h == pytest.approx((1.0, 0.0), abs=1e-6)
    assert result.velocity_error_percent == pytest.approx(100 * 0.53852 / 1.3, abs=0.01)


def test_a_turn_that_is_too_slow_is_missed_by_its_angle():
    result = measure(turning(0.5, 1.0), LocomotionCommand((1.0, 0.0), turn_rate=0.6))
    steady_s = SECONDS - SETTLE_S - 1 / 60
    assert result.stages[0].achieved_turn == pytest.approx(0.5)
    assert result.stages[0].achieved_h == pytest.approx((1.0, 0.0), abs=0.01)
    assert result.heading_error_deg == pytest.approx(np.degrees(0.1 * steady_s))


def test_feet_that_are_carried_along_slide_as_fast_as_the_root():
    still = pose(FRAMES)
    carried = differentiate(
        still.root_pos_w + np.outer(np.arange(FRAMES) * 0.1 / 60, [1.0, 0.0, 0.0]),
        still.root_quat_w,
        still.joint_pos,
        60.0,
    )
    assert measure(still, STAND).slide_standing_cm_s == pytest.approx(0.0, abs=1e-9)
    assert measure(carried, STAND).slide_standing_cm_s == pytest.approx(10.0)


def test_the_beginning_of_a_stage_does_not_count():
    frames = walk(FRAMES, speed=1.2).frames
    late = round((SETTLE_S - 0.2) * 60)
    jumped = frames.root_pos_w.copy()
    jumped[:late, 0] -= 3.0
    result = measure(replace(frames, root_pos_w=jumped), LocomotionCommand((1.2, 0.0)))
    assert result.velocity_error_percent == pytest.approx(0.0, abs=1e-6)


def test_a_drive_may_begin_later_than_its_frames_and_end_after_them():
    frames = state.concatenate([pose(120), walk(FRAMES, speed=1.2).frames])
    result = measure(frames, LocomotionCommand((1.2, 0.0)), STAND, first_s=2.0)
    assert [stage.commanded_h for stage in result.stages] == [(1.2, 0.0)]
    assert result.velocity_error_percent == pytest.approx(0.0, abs=1e-6)


@settings(max_examples=5, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-9.0, 9.0))
def test_where_and_whither_in_the_world_makes_no_difference(heading, shift):
    frames = walk(FRAMES, speed=1.0).frames
    moved = state.move(frames, np.full(FRAMES, heading), np.array([shift, -shift, 0.0]))
    here = measure(frames, LocomotionCommand((1.2, 0.1), 0.1))
    there = measure(moved, LocomotionCommand((1.2, 0.1), 0.1))
    assert there.velocity_error_percent == pytest.approx(here.velocity_error_percent)
    assert there.heading_error_deg == pytest.approx(here.heading_error_deg)
    assert there.slide_moving_cm_s == pytest.approx(here.slide_moving_cm_s, abs=1e-6)
