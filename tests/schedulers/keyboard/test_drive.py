"""Tests for drive.py."""

from __future__ import annotations

import math

import pytest

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.drive import Stage, command_at, drive_seconds, scripted_drive

WALK, BACK = LocomotionCommand((1.2, 0.0)), LocomotionCommand((-0.7, 0.0))
STAGES = [Stage("walk", 2.0, WALK), Stage("backward", 1.5, BACK)]


def test_a_command_is_held_until_the_next_stage_begins():
    assert command_at(STAGES, 0.0) is WALK
    assert command_at(STAGES, 1.99) is WALK
    assert command_at(STAGES, 2.0) is BACK
    assert command_at(STAGES, 3.49) is BACK


def test_before_and_after_the_drive_it_stands():
    assert command_at(STAGES, -0.01) is STAND
    assert command_at(STAGES, 3.5) is STAND
    assert drive_seconds(STAGES) == 3.5


def test_the_same_seed_is_the_same_drive_and_another_one_differs():
    assert scripted_drive(3) == scripted_drive(3)
    assert scripted_drive(3) != scripted_drive(4)


@pytest.mark.parametrize("seed", range(5))
def test_every_drive_has_what_a_person_does_with_the_keys(seed):
    names = {stage.name for stage in scripted_drive(seed)}
    turns = {"turn +90", "turn -90", "turn +180", "turn -180"}
    assert turns | {"walk", "jog", "stop", "sideways", "backward", "turn on the spot"} <= names


@pytest.mark.parametrize("seed", range(5))
def test_turns_last_as_long_as_their_angle_takes(seed):
    for stage in scripted_drive(seed):
        direction, _, degrees = stage.name.partition(" ")
        if direction == "turn" and degrees[0] in "+-":
            turned = stage.seconds * stage.command.turn_rate
            assert turned == pytest.approx(math.radians(float(degrees)))


@pytest.mark.parametrize("seed", range(5))
def test_every_drive_takes_two_minutes(seed):
    assert drive_seconds(scripted_drive(seed)) == pytest.approx(120.0)


def test_durations_of_seeds_differ_by_at_most_15_percent_each_way():
    walks = [next(s.seconds for s in scripted_drive(seed) if s.name == "walk") for seed in range(20)]
    assert len({round(walk, 3) for walk in walks}) == 20
    # all are stretched alike afterwards, by little
    assert max(walks) / min(walks) < 1.05 * 1.15 / 0.85
