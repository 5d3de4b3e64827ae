"""Tests for flight.py."""

from __future__ import annotations

import numpy as np

from tests.motion.gaits import jump, walk
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.flight import FlightConfig, air_frames, find_flights
from unicon.motion.grounding.solid_shapes import lowest_height, mass_centre
from unicon.state import CharacterState

CONFIG = FlightConfig()


def flights_of(frames: CharacterState):
    bodies = forward_kinematics(frames)
    return find_flights(mass_centre(bodies)[:, 2], lowest_height(bodies), CONFIG)


def test_a_jump_is_one_flight_with_the_acceleration_of_gravity():
    frames, air = jump()
    (flight,) = flights_of(frames)
    assert np.isclose(flight.acceleration, -9.81, atol=0.3)
    assert np.sum(air_frames([flight], len(air)) != air) <= 3


def test_a_slow_hand_made_jump_is_a_flight_too():
    frames, air = jump(gravity=3.5, rise_m=0.3)
    (flight,) = flights_of(frames)
    assert np.isclose(flight.acceleration, -3.5, atol=0.5)
    assert np.mean(air_frames([flight], len(air)) != air) < 0.1


def test_where_the_floor_is_doesnt_matter():
    frames, _ = jump()
    bodies = forward_kinematics(frames)
    heights = mass_centre(bodies)[:, 2], lowest_height(bodies)
    slope = 3.0 + np.linspace(0.0, 0.4, len(heights[0]))
    assert len(find_flights(heights[0] + slope, heights[1] + slope, CONFIG)) == 1


def test_a_fall_with_the_feet_on_the_ground_is_none():
    frames, _ = jump()
    mass_height = mass_centre(forward_kinematics(frames))[:, 2]
    assert find_flights(mass_height, np.zeros_like(mass_height), CONFIG) == []


def test_a_walk_has_no_flights():
    assert flights_of(walk(180, 1.4).frames) == []


def test_a_body_that_floats_without_falling_is_not_in_flight():
    height = 0.1 * np.exp(-(((np.arange(240) - 120) / 40.0) ** 2))
    assert find_flights(1.0 + height, height, CONFIG) == []


def test_a_clip_shorter_than_the_window_has_none():
    assert find_flights(np.zeros(5), np.zeros(5), CONFIG) == []
