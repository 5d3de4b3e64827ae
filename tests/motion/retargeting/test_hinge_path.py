"""Tests for hinge_path.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.motion.retargeting.hinge_path import find_path, limit_excess, nearest_turns

WIDE = np.array([2.0, 2.0, 2.0])


def test_the_excess_is_what_is_beyond_either_limit():
    excess = limit_excess(np.array([-3.0, 0.0, 2.5]), -WIDE, WIDE)
    assert excess == pytest.approx([1.0, 0.0, 0.5])


def test_whole_turns_are_chosen_by_the_target():
    assert nearest_turns(np.array([0.1, 6.0]), np.array([6.3, -0.2])) == pytest.approx(
        [0.1 + 2 * np.pi, 6.0 - 2 * np.pi]
    )


def test_the_way_within_the_limits_is_taken_from_the_beginning():
    count = 50
    inside = np.tile([0.5, 0.2, -0.3], (count, 1))
    outside = inside * np.array([1.0, -1.0, 1.0]) + np.pi
    found = find_path(np.stack([outside, inside]), np.zeros(2), 1.0, -WIDE, WIDE)
    assert found.angles == pytest.approx(inside)
    assert (found.way == 1).all()


def test_a_path_changes_over_where_its_axes_are_parallel_rather_than_leave_the_limits_for_long():
    """The middle angle goes through a right angle; beyond it the other way is within the limits."""
    middle = np.linspace(1.0, 2.2, 80)
    first = np.stack([np.full(80, 1.8), middle, np.full(80, 1.5)], axis=-1)
    second = first * np.array([1.0, -1.0, 1.0]) + np.array([-np.pi, np.pi, -np.pi])
    lower, upper = np.array([-2.5, -1.6, -2.5]), np.array([2.5, 1.6, 2.5])
    found = find_path(np.stack([first, second]), np.zeros(2), -1.0, lower, upper)
    changes = np.flatnonzero(np.diff(found.way))
    assert len(changes) == 1
    assert abs(middle[changes[0]] - np.pi / 2) < 0.2


def test_a_way_with_a_price_is_taken_only_where_it_helps():
    cheap = np.tile([0.0, 0.0, 0.0], (60, 1))
    cheap[20:40, 0] = 2.6
    spun = np.tile([0.1, 0.0, 0.0], (60, 1))
    spun[20:40, 0] = 1.9
    ways = np.stack([cheap, cheap + np.pi, spun, spun + np.pi])
    found = find_path(ways, np.array([0.0, 0.0, 0.1, 0.1]), 1.0, -WIDE, WIDE)
    assert (found.way[[0, -1]] == 0).all()
    assert (found.way[22:38] == 2).all()
