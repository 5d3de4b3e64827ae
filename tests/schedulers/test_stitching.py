"""Tests for stitching.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon import rotations
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip import Clip, clip_from_poses
from unicon.schedulers.stitching import Stitcher, StitcherConfig

TICK_NS = 1_000_000_000 // 60


def walking_clip(name: str = "walk", seconds: float = 1.0, heading: float = 0.0) -> Clip:
    times = np.arange(round(seconds * 60) + 1) / 60
    rest = HUMANOID.rest_state()
    direction = np.array([np.cos(heading), np.sin(heading), 0.0])
    joint_pos = np.zeros((len(times), 35))
    joint_pos[:, HUMANOID.joint_names.index("left_hip_y")] = 0.3 * np.sin(2 * np.pi * times)
    return clip_from_poses(
        name,
        rest.root_pos_w + 1.5 * times[:, None] * direction + np.array([7.0, -3.0, 0.0]),
        np.tile(rotations.from_heading(np.array(heading)), (len(times), 1)),
        joint_pos,
    )


def play(stitcher: Stitcher, ticks: int, first: int = 0) -> list:
    return [stitcher.next_frames((first + k) * TICK_NS) for k in range(ticks)]


def path_of(windows: list) -> np.ndarray:
    return np.array([window.frames.root_pos_w[0] for window in windows])


def test_an_empty_queue_stands_in_the_rest_pose():
    stitcher = Stitcher(StitcherConfig(), 0)
    for window in play(stitcher, 200):
        assert window.frames.batch_shape == (8,)
        assert not window.frames.root_lin_vel_w.any()
        assert np.allclose(window.frames.joint_pos, 0.0)
    assert stitcher.empty


def test_windows_begin_one_frame_ahead_and_follow_each_other():
    stitcher = Stitcher(StitcherConfig(window=3), 1000)
    times = [stitcher.next_frames(1000 + k * TICK_NS).time_ns for k in range(100)]
    assert times[0] == 1000 + round(1e9 / 60)
    assert np.all(np.abs(np.diff(times) - 1e9 / 60) <= 1)


@pytest.mark.parametrize("transition_s", [0.0, 0.25, 1.0])
@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_clip_begins_where_the_path_ends_whatever_its_own_place(transition_s, heading):
    stitcher = Stitcher(StitcherConfig(), 0)
    stitcher.queue(walking_clip(heading=heading), transition_s)
    path = path_of(play(stitcher, 200))
    assert np.allclose(path[0], HUMANOID.rest_state().root_pos_w)
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    assert steps.max() < 1.5 * 1.6 / 60
    assert np.allclose(path[:, 1], 0.0, atol=1e-9)
    # of its second at 1.5 m/s half of the transition is lost; going over into standing takes half of another
    moving_s = 1 / 60 + 1.0 - transition_s / 2 + StitcherConfig.transition_s / 2
    assert np.isclose(path[-1, 0], 1.5 * moving_s, atol=1e-3)


def test_two_clips_keep_the_heading_and_speed_at_the_seam():
    stitcher = Stitcher(StitcherConfig(), 0)
    stitcher.queue(walking_clip("first"), 0.5)
    stitcher.queue(walking_clip("second", heading=-1.0), 0.3)
    windows = play(stitcher, 130)
    seam = slice(60, 110)
    speeds = np.array([w.frames.root_lin_vel_w[0] for w in windows])[seam]
    assert np.allclose(speeds[:, 0], 1.5, atol=0.05)
    assert np.allclose(speeds[:, 1], 0.0, atol=0.05)


def test_velocities_are_those_of_the_path_itself():
    stitcher = Stitcher(StitcherConfig(window=1), 0)
    stitcher.queue(walking_clip(), 0.4)
    windows = play(stitcher, 150)
    joints = np.array([w.frames.joint_pos[0] for w in windows])
    velocities = np.array([w.frames.joint_vel[0] for w in windows])
    assert np.allclose(velocities[1:-1], (joints[2:] - joints[:-2]) * 30, atol=0.4)


def test_it_goes_over_into_standing_where_the_last_clip_ended():
    stitcher = Stitcher(StitcherConfig(), 0)
    stitcher.queue(walking_clip(), 0.2)
    play(stitcher, 10)
    assert stitcher.playing.name == "walk"
    assert not stitcher.empty
    last = play(stitcher, 200, first=10)[-1]
    assert stitcher.empty
    assert np.allclose(last.frames.joint_pos, 0.0)
    assert not last.frames.root_lin_vel_w.any()
    assert last.frames.root_pos_w[0, 0] > 1.4


def test_clearing_forgets_what_waits_and_keeps_what_was_sent():
    stitcher = Stitcher(StitcherConfig(window=4), 0)
    stitcher.queue(walking_clip(seconds=3.0), 0.2)
    stitcher.queue(walking_clip("never"), 0.2)
    before = play(stitcher, 60)[-1]
    stitcher.clear()
    after = stitcher.next_frames(60 * TICK_NS)
    assert np.allclose(after.frames.root_pos_w[:3], before.frames.root_pos_w[1:])
    assert stitcher.queued == []
    end = play(stitcher, 120, first=61)
    assert np.abs(np.diff(path_of(end), axis=0)).max() < 0.05
    assert stitcher.empty


def test_a_late_tick_skips_frames_and_keeps_the_time():
    stitcher = Stitcher(StitcherConfig(), 0)
    stitcher.queue(walking_clip(seconds=2.0), 0.0)
    early = stitcher.next_frames(10 * TICK_NS)
    late = stitcher.next_frames(20 * TICK_NS)
    moved = late.frames.root_pos_w[0] - early.frames.root_pos_w[0]
    assert np.isclose(moved[0], 1.5 * 10 / 60, atol=1e-3)


@pytest.mark.parametrize("transition_s", [5.1, float("nan"), float("inf")])
def test_a_transition_out_of_range_is_refused(transition_s):
    with pytest.raises(UniconError, match="expected 0 to 5"):
        Stitcher(StitcherConfig(), 0).queue(walking_clip(), transition_s)


def test_a_long_run_does_not_keep_its_whole_past():
    stitcher = Stitcher(StitcherConfig(), 0)
    for _ in range(5):
        stitcher.queue(walking_clip(seconds=2.0), 0.1)
    play(stitcher, 700)
    assert stitcher._path.batch_shape[0] < 600
