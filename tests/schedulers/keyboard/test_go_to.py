"""Tests for go_to.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.schedulers.keyboard.command import STAND
from unicon.schedulers.keyboard.go_to import REST_S, SLOW_S, STUCK_S, Destination, GoTo


def test_far_away_it_walks_at_the_speed_and_faces_the_point():
    going = GoTo(Destination((4.0, 4.0), speed_m_s=1.2), np.zeros(2))
    progress = going.steer(np.zeros(2), np.pi / 4)
    assert progress.state == "going"
    assert progress.command.velocity_h == pytest.approx((1.2, 0.0))
    assert progress.command.facing_w == pytest.approx(np.pi / 4)
    assert progress.distance_m == pytest.approx(4 * np.sqrt(2))


def test_it_slows_down_before_the_point():
    going = GoTo(Destination((4.0, 0.0)), np.zeros(2))
    assert going.steer(np.array([3.3, 0.0]), 0.0).command.velocity_h[0] == pytest.approx(0.7 / SLOW_S)


def test_near_by_it_steps_at_the_point_whatever_it_faces():
    going = GoTo(Destination((4.0, 0.0)), np.zeros(2))
    command = going.steer(np.array([3.5, 0.0]), np.pi / 2).command
    assert command.velocity_h[0] == pytest.approx(0.0, abs=1e-9)
    assert command.velocity_h[1] < -0.3


def test_there_it_turns_and_then_stands():
    going = GoTo(Destination((1.0, 0.0), facing_w=2.0), np.zeros(2))
    turning = going.steer(np.array([0.95, 0.0]), 0.0)
    assert turning.state == "going"
    assert turning.command.facing_w == 2.0
    resting = going.steer(np.array([0.95, 0.0]), 1.95)
    assert resting.state == "going"
    assert resting.command == STAND
    arrived = [going.steer(np.array([0.95, 0.0]), 1.95) for _ in range(round(REST_S * 60) + 1)][-1]
    assert arrived.state == "arrived"
    assert arrived.share == pytest.approx(0.95)


def test_who_comes_no_nearer_gives_up():
    going = GoTo(Destination((5.0, 0.0)), np.zeros(2))
    states = [going.steer(np.array([1.0, 0.0]), 0.0).state for _ in range(round(STUCK_S * 60) + 5)]
    assert states[0] == "going"
    assert states[-1] == "stuck"
