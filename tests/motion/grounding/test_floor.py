"""Tests for floor.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.motion.grounding.flight import Flight
from unicon.motion.grounding.floor import FloorConfig, height_change

CONFIG = FloorConfig()
COUNT = 120
FRAMES = np.arange(COUNT)


def parabola(start: int, stop: int, gravity: float) -> np.ndarray:
    """Return heights ``(T,)`` that rise and fall between two frames, and are zero elsewhere."""
    times = (FRAMES - start) / 60
    height = 0.5 * gravity * times * ((stop - start) / 60 - times)
    return np.where((start < FRAMES) & (stop > FRAMES), height, 0.0)


@pytest.mark.parametrize("offset", [-0.7, 0.0, 2.0])
def test_a_motion_anywhere_comes_onto_the_floor(offset):
    lowest = np.full(COUNT, offset)
    assert np.allclose(lowest + height_change(lowest, lowest + 1.0, [], CONFIG), 0.0, atol=1e-9)


def test_a_floor_that_slopes_is_levelled_to_the_very_ends():
    lowest = np.linspace(-0.1, 0.3, COUNT)
    assert np.allclose(lowest + height_change(lowest, lowest + 1.0, [], CONFIG), 0.0, atol=1e-6)


def test_what_floats_for_a_while_is_brought_down():
    lowest = 0.15 * np.exp(-(((FRAMES - 60) / 20.0) ** 2))
    result = lowest + height_change(lowest, lowest + 1.0, [], CONFIG)
    assert np.abs(result).max() < 0.01


def test_what_jerks_ends_up_above_the_floor_rather_than_below():
    lowest = np.where((FRAMES > 50) & (FRAMES < 56), -0.05, 0.0)
    result = lowest + height_change(lowest, lowest + 1.0, [], CONFIG)
    assert result.min() > -0.02
    assert np.abs(np.diff(result - lowest, 2)).max() < 0.012


@pytest.mark.parametrize("gravity", [8.0, 9.81, 12.0])
def test_a_flight_falls_with_gravity_from_take_off_to_landing(gravity):
    lowest = parabola(40, 70, gravity)
    flight = Flight(41, 70, -gravity)
    result = lowest + height_change(lowest, lowest + 1.0, [flight], CONFIG)
    inner = slice(42, 69)
    assert np.allclose(np.gradient(np.gradient(result))[inner][2:-2] * 3600, -9.81, atol=0.05)
    assert abs(result[40]) < 0.02
    assert abs(result[70]) < 0.02
    # g T^2 / 8 with T = 0.5 s.
    assert np.isclose(result[55], 9.81 * 0.25 / 8, atol=0.02)


def test_a_flight_that_is_far_too_slow_is_corrected_only_so_far():
    lowest = parabola(20, 100, 2.0)
    result = lowest + height_change(lowest, lowest + 1.0, [Flight(21, 100, -2.0)], CONFIG)
    assert np.abs(result - lowest).max() < 1.3 * CONFIG.largest_lift_m
    assert result.max() > lowest.max() + 0.5 * CONFIG.largest_lift_m


def test_a_clip_of_two_frames_is_enough():
    lowest = np.array([0.2, 0.3])
    assert np.allclose(lowest + height_change(lowest, lowest, [], CONFIG), 0.0)
