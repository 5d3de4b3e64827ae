"""Tests for support.py and words.py: what needs props or uneven ground."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import cleaned, figure, joined, lively, moved, turned
from unicon.motion.cleaning import Hints
from unicon.motion.cleaning.body_paths import body_paths
from unicon.motion.cleaning.support import Support, mass_centre
from unicon.motion.cleaning.words import marks_from_words


def sitting(count: int):
    """Thighs level, shins upright, as on a chair."""
    motion = moved(figure(count, height=0.45), np.outer(0.005 * np.sin(0.1 * np.arange(count)), [1.0, 0, 0]))
    for side in ("left", "right"):
        motion = turned(motion, f"{side}_hip", "y", -np.pi / 2)
        motion = turned(motion, f"{side}_knee", "y", np.pi / 2)
    return turned(motion, "chest", "y", 0.03 * np.sin(0.07 * np.arange(count)))


def test_the_centre_of_mass_of_a_standing_figure_is_over_its_feet():
    centre = mass_centre(body_paths(figure(1)))[0]
    assert abs(centre[0]) < 0.02 and abs(centre[1]) < 1e-9 and 0.7 < centre[2] < 1.1


def test_sitting_on_nothing_needs_a_prop():
    result = cleaned(sitting(180))
    assert result.marks == ("prop",)
    assert "weight beside" in result.decisions[0].text


def test_sitting_on_the_floor_needs_none():
    motion = moved(sitting(180), np.array([0.0, 0.0, -0.45]))
    for side in ("left", "right"):
        motion = turned(motion, f"{side}_knee", "y", -np.pi / 2)
    assert cleaned(motion).marks == ()


def test_hanging_for_longer_than_a_jump_needs_a_prop():
    rise = 0.8 * np.clip(1.5 - np.abs(np.arange(300) - 150) / 60, 0.0, 1.0)
    hanging = moved(lively(300, speed=0.1), np.outer(rise, [0.0, 0.0, 1.0]))
    for side in ("left", "right"):
        hanging = turned(hanging, f"{side}_shoulder", "y", np.pi)
    result = cleaned(hanging)
    assert result.marks == ("prop",) and "near the floor" in result.decisions[0].text


def test_a_high_jump_needs_none():
    t = np.clip((np.arange(300) - 150) / 60 / 0.4, -1.0, 1.0)
    assert cleaned(moved(lively(300), np.outer(0.78 * (1 - t * t), [0.0, 0.0, 1.0]))).marks == ()


def stairs(steps: int, rise_m: float):
    """Stand on one step after the other."""
    levels = np.repeat(np.arange(steps), 60)
    smooth = np.convolve(np.pad(levels, 10, mode="edge"), np.ones(21) / 21, mode="valid") * rise_m
    motion = moved(figure(len(levels)), np.outer(smooth, [0.0, 0.0, 1.0]))
    return turned(motion, "neck", "y", 0.1 * np.sin(0.11 * np.arange(len(levels))))


def test_standing_at_several_heights_needs_uneven_ground():
    result = cleaned(stairs(5, 0.15))
    assert result.marks == ("uneven_ground",)
    assert "m apart" in result.decisions[0].text


def test_a_floor_that_is_off_by_some_centimetres_is_even():
    assert cleaned(stairs(2, 0.05)).marks == ()


def test_a_raised_leg_is_no_step():
    motion = turned(lively(300, speed=0.0), "left_hip", "y", -1.4)
    assert Support(body_paths(motion)).standing_heights().size == 0 or cleaned(motion).marks != (
        "uneven_ground",
    )


def test_marks_come_once_each_and_in_a_fixed_order():
    motion = joined(stairs(5, 0.15), sitting(180))
    result = cleaned(motion, description="climb stairs and sit on a chair")
    assert result.marks == ("prop", "uneven_ground")


@pytest.mark.parametrize(
    ("description", "mark"),
    [
        ("playground - climb, hang, swing", "prop"),
        ("sit on high stool, stand up", "prop"),
        ("Get up from chair", "prop"),
        ("SittingDown", "prop"),
        ("climb 3 steps", "uneven_ground"),
        ("Walking up and down stairs", "uneven_ground"),
        ("walk on uneven terrain", "uneven_ground"),
    ],
)
def test_words_tell_of_things_that_are_not_there(description, mark):
    assert mark in marks_from_words(Hints(description=description))


@pytest.mark.parametrize(
    "description",
    [
        "walk",
        "boxing",
        "golf swing",
        "hanging a picture",
        "basketball - crossover dribble, shoot",
        "walk sideways and turn (opposite direction)",
        "sitting on ground relaxing",
        "sit ups",
        "salsa dance",
        "closing a box",
        "forward stride, long steps",
        "CleanedGRS LeftTightTurn",
    ],
)
def test_other_words_tell_nothing(description):
    assert marks_from_words(Hints(description=description)) == {}


def test_a_session_tells_where_the_take_says_nothing_or_all_of_it_is_alike():
    assert marks_from_words(Hints(context="jumps; hopscotch; sits")) == {"prop": "sits"}
    assert marks_from_words(Hints(description="hopscotch", context="jumps; hopscotch; sits")) == {}
    assert marks_from_words(Hints(description="Lean Turn", context="Skateboard Motions")) == {
        "prop": "skateboard"
    }


def test_the_name_of_the_file_tells_too():
    assert marks_from_words(Hints(file="a.zip/b/Sitting_Idle_Loop.bvh")) == {"prop": "sitting"}
