"""Tests for scheduler.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.schedulers.keyboard.steerable import CARD, Steerable
from unicon import rotations, state
from unicon.humanoid import HUMANOID
from unicon.schedulers.keyboard.command import LocomotionCommand
from unicon.schedulers.keyboard.go_to import Destination
from unicon.schedulers.keyboard.scheduler import STANDING_LEASH_M, KeyboardConfig, KeyboardScheduler

TICK_NS = 1_000_000_000 // 60
FORWARD = LocomotionCommand((1.2, 0.0))


def scheduler(**changes) -> KeyboardScheduler:
    return KeyboardScheduler(Steerable(), CARD, KeyboardConfig(**changes), 0)


def run(made: KeyboardScheduler, ticks: int, command=None, first: int = 0) -> list:
    windows = []
    for tick in range(first, first + ticks):
        if command is not None:
            made.command(command, tick * TICK_NS)
        windows.append(made.next_frames(tick * TICK_NS))
    return windows


def test_windows_begin_one_frame_ahead_and_follow_each_other():
    windows = run(scheduler(window=3), 60, FORWARD)
    assert windows[0].time_ns == round(1e9 / 60)
    assert all(window.frames.batch_shape == (3,) for window in windows)
    for before, after in zip(windows, windows[1:], strict=False):
        assert np.array_equal(before.frames.root_pos_w[1], after.frames.root_pos_w[0])


def test_a_command_shows_in_the_last_frame_of_the_next_window():
    made, usual = scheduler(window=2), scheduler(window=2)
    run(made, 30)
    run(usual, 30)
    made.command(FORWARD, 30 * TICK_NS)
    changed, same = made.next_frames(30 * TICK_NS), usual.next_frames(30 * TICK_NS)
    assert np.array_equal(changed.frames.root_pos_w[0], same.frames.root_pos_w[0])
    assert not np.array_equal(changed.frames.root_pos_w[1], same.frames.root_pos_w[1])


def test_a_command_that_stops_coming_stops_the_character():
    made = scheduler(timeout_s=0.5)
    moving = run(made, 120, FORWARD)[-1]
    assert moving.frames.root_lin_vel_w[0, 0] > 1.0
    still = run(made, 200, first=120)[-1]
    assert not still.frames.root_lin_vel_w.any()


def test_what_is_too_much_is_said():
    assert scheduler().command(LocomotionCommand((9.0, 0.0)), 0) == ("speed 9.00 to 3.00 m/s",)


def test_it_goes_on_from_where_it_is_placed():
    made = scheduler()
    run(made, 60, FORWARD)
    made.place(np.array([5.0, -2.0]), 1.5)
    after = run(made, 1, FORWARD, first=60)[0]
    assert np.allclose(after.frames.root_pos_w[0, :2], [5.0, -2.0], atol=0.1)
    assert rotations.heading_angle(after.frames.root_quat_w)[0] == pytest.approx(1.5, abs=0.05)
    later = run(made, 60, FORWARD, first=61)[-1]
    moved = later.frames.root_pos_w[0, :2] - [5.0, -2.0]
    assert np.arctan2(moved[1], moved[0]) == pytest.approx(1.5, abs=0.05)


def follow(made: KeyboardScheduler, avatar, tick: int) -> None:
    """Let the executor have followed the frame as it was sent."""
    target = made.generator.state if tick == 0 else made._frames[0]
    made.follow(avatar, target, made._first * TICK_NS)


def avatar_at(pos_w: list[float], heading: float = 0.0):
    return state.move(HUMANOID.rest_state(), np.array(heading), np.array([*pos_w, 0.0]))


def test_open_loop_nothing_of_the_avatar_counts():
    made, alone = scheduler(), scheduler()
    for tick in range(60):
        follow(made, avatar_at([3.0, 1.0]), tick)
        ours, theirs = run(made, 1, FORWARD, tick)[0], run(alone, 1, FORWARD, tick)[0]
    assert np.array_equal(ours.frames.root_pos_w, theirs.frames.root_pos_w)


def test_with_feedback_a_reference_that_goes_is_drawn_to_the_avatar():
    made, alone = scheduler(feedback=0.2), scheduler()
    for tick in range(90):
        ours, theirs = (run(each, 1, FORWARD, tick)[0] for each in (made, alone))
        # half a metre to the left of where it would be by itself
        place = theirs.frames.root_pos_w[0, :2] + [0.0, 0.5]
        follow(made, avatar_at(place), tick)
    assert np.allclose(ours.frames.root_pos_w[0, :2], place, atol=0.1)


def test_with_feedback_a_reference_that_stands_stays_where_it_is():
    made = scheduler(feedback=0.2)
    for tick in range(60):
        follow(made, avatar_at([0.2, 0.15], 0.5), tick)
        window = run(made, 1, first=tick)[0]
    assert np.allclose(window.frames.root_pos_w[0, :2], [0.0, 0.0], atol=0.01)


def test_with_feedback_a_reference_that_stands_comes_after_an_avatar_as_far_as_the_leash():
    made = scheduler(feedback=0.05)
    for tick in range(240):
        follow(made, avatar_at([0.6, 0.8], 0.5), tick)
        window = run(made, 1, first=tick)[0]
    # the avatar stands 1 m off in the direction (0.6, 0.8)
    nearest = (1.0 - STANDING_LEASH_M) * np.array([0.6, 0.8])
    assert np.allclose(window.frames.root_pos_w[0, :2], nearest, atol=0.01)
    assert rotations.heading_angle(window.frames.root_quat_w[0]) == pytest.approx(0.0, abs=0.01)


def test_it_waits_for_an_avatar_that_lags():
    made = scheduler(wait_m=(0.3, 0.6))
    for tick in range(240):
        follow(made, avatar_at([0.0, 0.0]), tick)
        window = run(made, 1, FORWARD, tick)[0]
    assert 0.3 < window.frames.root_pos_w[0, 0] < 1.2
    assert window.frames.root_lin_vel_w[0, 0] == pytest.approx(0.0, abs=0.05)


def test_it_says_in_which_gait_it_goes():
    made = scheduler()
    assert made.playing == "stand"
    run(made, 120, FORWARD)
    assert made.playing == "walk"


def test_a_late_tick_skips_frames_and_keeps_the_time():
    made = scheduler()
    run(made, 100, FORWARD)
    early = made.next_frames(100 * TICK_NS)
    made.command(FORWARD, 110 * TICK_NS)
    late = made.next_frames(110 * TICK_NS)
    assert late.time_ns - early.time_ns == pytest.approx(10 * TICK_NS, abs=20)
    assert late.frames.root_pos_w[0, 0] - early.frames.root_pos_w[0, 0] == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize("anchored", [False, True])
def test_it_walks_to_a_place_in_the_world_and_faces_as_asked(anchored):
    made = scheduler()
    run(made, 5)
    if anchored:
        frame = made._frames[0]
        moved = state.move(frame, np.array(1.0), np.array([2.0, -1.0, 0.0]))
        made.follow(moved, moved, made._first * TICK_NS)
    made.go_to(Destination((-2.0, 1.5), facing_w=0.7))
    run(made, 900, first=5)
    assert made.progress is not None
    assert made.progress.state == "arrived"
    place = made.anchor.to_world(made.generator.state.root_pos_w[:2])
    assert np.linalg.norm(place - [-2.0, 1.5]) < 0.3
    off = made.generator.heading + made.anchor.turn - 0.7
    assert abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi) < 0.25


def test_a_key_ends_the_walk_to_a_place():
    made = scheduler()
    made.go_to(Destination((5.0, 0.0)))
    run(made, 60)
    made.command(LocomotionCommand((-0.5, 0.0)), 60 * TICK_NS)
    window = run(made, 20, LocomotionCommand((-0.5, 0.0)), first=60)
    late = run(made, 200, LocomotionCommand((-0.5, 0.0)), first=80)[-1]
    assert late.frames.root_pos_w[0, 0] < window[0].frames.root_pos_w[0, 0]
