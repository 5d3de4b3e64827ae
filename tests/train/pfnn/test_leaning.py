"""Tests for leaning.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.pfnn.walking_samples import walker
from unicon import rotations
from unicon.train.pfnn.leaning import GRAVITY_M_S2, acceleration_h, lean
from unicon.train.pfnn.synthesis import bend, sequence


def _up_h(frames):
    """Return where the root's upward axis points, as the root faces."""
    up_w = rotations.rotate(frames.root_quat_w, np.array([0.0, 0.0, 1.0]))
    return rotations.rotate(rotations.conjugate(rotations.heading(frames.root_quat_w)), up_w)


def test_a_walk_as_captured_is_left_as_it_is():
    frames = walker("walk", 4.0, speed=1.2).frames
    leant = lean(frames, [frames])
    assert np.allclose(leant.root_quat_w, frames.root_quat_w, atol=1e-9)
    assert np.allclose(leant.root_pos_w, frames.root_pos_w, atol=1e-9)


def test_a_bend_to_the_left_is_leant_into_by_its_centripetal_acceleration():
    frames = walker("walk", 6.0, speed=2.0).frames
    leant = lean(bend(frames, 0.8), [frames])
    middle = slice(120, 240)
    angle = np.arctan(2.0 * 0.8 / GRAVITY_M_S2)  # v omega / g: 9.3 degrees
    assert np.allclose(_up_h(leant)[middle, 1], np.sin(angle), rtol=0.02)
    assert np.allclose(_up_h(leant)[middle, 0], 0.0, atol=0.02)
    # the middle of the body moves inward by its height times the sine, and the point below stays
    inward = leant.root_pos_w - bend(frames, 0.8).root_pos_w
    height = frames.root_pos_w[0, 2]
    assert np.allclose(np.linalg.norm(inward[middle, :2], axis=-1), height * np.sin(angle), rtol=0.02)
    assert np.allclose(leant.root_pos_w[middle, 2], height * np.cos(angle), rtol=1e-3)


def test_who_sets_off_leans_forward_and_who_stops_leans_back():
    stand = walker("stand", 2.0, speed=0.0, step=0.0).frames
    walk = walker("walk", 4.0, speed=1.2).frames
    parts = [stand, walk, stand]
    path = sequence(parts, [0.8, 0.8])
    forward = _up_h(lean(path, parts))[:, 0]
    starts = slice(120, 168)
    stops = slice(360, 408)
    assert forward[starts].max() > 0.05
    assert forward[stops].min() < -0.05
    assert abs(forward[240]) < 0.01


def test_acceleration_is_seen_as_the_root_faces():
    frames = bend(walker("walk", 6.0, speed=2.0).frames, 0.5)
    assert acceleration_h(frames)[180] == pytest.approx([0.0, 2.0 * 0.5, 0.0], abs=0.02)
