"""Tests for frames.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon import rotations
from unicon.motion.retargeting.frames import across, angle_between, frame, unit


def test_a_direction_has_length_one_and_nothing_stays_nothing():
    assert unit(np.array([0.0, 3.0, 4.0])) == pytest.approx([0.0, 0.6, 0.8])
    assert unit(np.zeros(3)) == pytest.approx(np.zeros(3))


def test_the_part_across_is_perpendicular():
    assert across(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0])) == pytest.approx([1.0, 2.0, 0.0])


def test_a_frame_has_its_axes_where_they_are_wanted():
    """Up along x and left along y, as of one who lies on the back: forward is -z."""
    turn = frame(np.array([2.0, 0.0, 0.0]), np.array([0.5, 1.0, 0.0]))
    assert rotations.to_matrix(turn) == pytest.approx(np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]))


def test_angles_between_vectors():
    assert angle_between(np.array([1.0, 0, 0]), np.array([0.0, 2, 0])) == pytest.approx(np.pi / 2)
    assert angle_between(np.array([1.0, 0, 0]), np.array([1.0, 1e-9, 0])) == pytest.approx(1e-9)
