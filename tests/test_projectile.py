"""Tests for projectile.py: random throws; aims and impacts are in test_simulation.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.projectile import Barrage
from unicon.simulation import Simulation, SimulationConfig


def test_the_same_generator_throws_the_same_balls_from_all_sides_at_all_bodies():
    first, second = ([Barrage(5).draw(rng) for _ in range(400)] for rng in map(np.random.default_rng, (3, 3)))
    assert first == second
    assert {ball.body for ball in first} == set(HUMANOID.body_names)
    azimuths = np.array([ball.azimuth_rad for ball in first])
    assert azimuths.min() < -3.0 and azimuths.max() > 3.0
    elevations = np.array([ball.elevation_rad for ball in first])
    assert 0.0 <= elevations.min() and elevations.max() <= Barrage(5).max_elevation_rad


@pytest.mark.parametrize("every", [1, 3, 20, 80])
def test_no_ball_is_taken_out_of_the_air_for_another(every):
    barrage = Barrage(every)
    simulation = Simulation(SimulationConfig(barrage.balls, barrage.lifetime_s))
    rng, thrown, flying = np.random.default_rng(0), 0, []
    for tick in range(60):
        if tick % every == 0:
            simulation.throw(barrage.draw(rng))
            thrown += 1
            assert len(simulation.ball_positions_w) < barrage.balls or every == 1
        flying.append(len(simulation.ball_positions_w))
        simulation._age_balls()
    lifetime = round(barrage.lifetime_s * 60)
    assert max(flying) == min(thrown, -(-(lifetime + 1) // every))


def test_a_barrage_of_nonsense_is_refused():
    for wrong in (
        {"every_ticks": 0},
        {"every_ticks": 5, "mass_kg": 0.0},
        {"every_ticks": 5, "lifetime_s": 0.0},
    ):
        with pytest.raises(UniconError):
            Barrage(**wrong)
