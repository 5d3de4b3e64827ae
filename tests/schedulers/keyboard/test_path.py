"""Tests for path.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.path import HERE, PathConfig, SteeredPath
from unicon.schedulers.pfnn.layout import AHEAD, GAITS, PRESENT

FORWARD = LocomotionCommand((1.2, 0.0))


def standing(pos=(0.0, 0.0), heading=0.0) -> SteeredPath:
    return SteeredPath(PathConfig(), np.array(pos), heading, 2.0)


def test_at_first_it_stands():
    path = standing((3.0, 1.0), 0.5)
    samples = path.samples()
    assert not samples.pos_h.any()
    assert np.allclose(samples.facing_h, [1.0, 0.0])
    assert path.standing == 1.0


def test_the_end_of_the_path_ahead_has_the_commanded_velocity():
    path = standing()
    path.steer(FORWARD)
    # at i = 60 the weight is 1
    assert np.linalg.norm(path.pos_w[-1] - path.pos_w[-2]) * 60 == pytest.approx(1.2)
    # at i = 1 it is 1 - (59/60)^bias
    first = 1.0 - (59 / 60) ** PathConfig.position_bias
    assert path.pos_w[HERE + 1, 0] * 60 == pytest.approx(1.2 * first)
    assert path.standing < 1.0


def test_a_turn_rate_turns_what_lies_ahead_and_the_path_bends_with_it():
    path = standing()
    for _ in range(50):
        path.steer(LocomotionCommand((1.2, 0.0), 1.0))
    assert path.heading[-1] == pytest.approx(1.0, abs=0.01)
    assert path.pos_w[-1, 1] > 0.3


@pytest.mark.parametrize("facing", [0.5, -0.5, 3.0, -3.0])
def test_a_facing_is_approached_the_shorter_way_and_not_passed(facing):
    path = standing(heading=0.2)
    for _ in range(200):
        path.steer(LocomotionCommand(facing_w=facing))
        turn = path.heading[HERE + 1] - path.heading[HERE]
        ahead = path.heading[HERE + np.arange(AHEAD) * 10] - path.heading[HERE + 1]
        path.advance(
            np.zeros(2), turn, np.zeros((AHEAD, 2)), np.stack([np.cos(ahead), np.sin(ahead)], axis=-1)
        )
    assert abs(path.heading[HERE] - 0.2) < np.pi
    assert np.remainder(path.heading[HERE] - facing + np.pi, 2 * np.pi) - np.pi == pytest.approx(
        0.0, abs=0.02
    )


def test_the_past_is_where_the_root_was():
    path = standing()
    ahead = np.stack([np.arange(AHEAD) * 0.2, np.zeros(AHEAD)], axis=-1)
    for _ in range(60):
        path.advance(np.array([0.02, 0.0]), 0.0, ahead, np.tile([1.0, 0.0], (AHEAD, 1)))
    samples = path.samples()
    assert np.allclose(samples.pos_h[: PRESENT + 1, 0], -0.2 * np.arange(PRESENT, -1, -1))
    assert np.allclose(samples.pos_h[PRESENT:, 0], 0.2 * np.arange(AHEAD))


def test_gaits_ahead_are_those_of_the_pace():
    path = standing()
    for _ in range(200):
        path.steer(LocomotionCommand((2.4, 0.0)))
    assert GAITS[int(path.gait[-1].argmax())] == "jog"
    for _ in range(200):
        path.steer(STAND)
    assert path.standing == pytest.approx(1.0)


@settings(max_examples=20, deadline=None)
@given(st.floats(-3, 3), st.floats(-9, 9), st.floats(-1, 1))
def test_samples_do_not_depend_on_place_and_heading(heading, shift, turn_rate):
    here, there = standing(), standing((shift, -shift), heading)
    for path in (here, there):
        for _ in range(5):
            path.steer(LocomotionCommand((1.0, 0.3), turn_rate))
    a, b = here.samples(), there.samples()
    assert np.allclose(a.pos_h, b.pos_h, atol=1e-9)
    assert np.allclose(a.facing_h, b.facing_h, atol=1e-9)


def test_placing_moves_past_and_future_alike():
    path = standing()
    path.steer(LocomotionCommand((1.0, 0.5), 0.5))
    before = path.samples()
    path.place(np.array([4.0, 5.0]), 2.0)
    after = path.samples()
    assert np.allclose(path.pos_w[HERE], [4.0, 5.0])
    assert np.allclose(before.pos_h, after.pos_h)
    assert np.allclose(before.facing_h, after.facing_h)
