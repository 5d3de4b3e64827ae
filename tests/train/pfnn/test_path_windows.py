"""Tests for path_windows.py and gaits.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.train.pfnn.walking_samples import walker
from unicon import state
from unicon.schedulers.pfnn.layout import GAITS, PRESENT
from unicon.train.pfnn.path_windows import path_of, windows_ahead, windows_around


def test_samples_of_a_straight_walk_lie_along_the_x_axis_10_frames_apart():
    path = path_of(walker("walk", 6.0, speed=1.2).frames)
    samples = windows_around(path, np.array([180]))
    assert np.allclose(samples.pos_h[0, :, 0], (np.arange(12) - PRESENT) * 1.2 / 6, atol=1e-3)
    assert np.allclose(samples.pos_h[0, :, 1], 0.0, atol=1e-9)
    assert np.allclose(samples.facing_h[0], [1.0, 0.0])
    assert GAITS[int(samples.gait[0, PRESENT].argmax())] == "walk"


def test_beyond_its_ends_a_take_stays_where_it_is():
    path = path_of(walker("stand", 3.0, speed=0.0, step=0.0).frames)
    samples = windows_around(path, np.array([0, 180]))
    assert np.allclose(samples.pos_h, 0.0)
    assert samples.gait[..., GAITS.index("stand")] == pytest.approx(1.0)


def test_the_path_ahead_begins_at_its_own_frame():
    path = path_of(walker("walk", 6.0).frames)
    pos_h, facing_h = windows_ahead(path, np.array([180]))
    assert pos_h.shape == facing_h.shape == (1, 6, 2)
    assert np.allclose(pos_h[0, 0], 0.0)
    assert pos_h[0, 5, 0] == pytest.approx(5 / 6, abs=1e-3)


@settings(max_examples=10, deadline=None)
@given(st.floats(-3, 3), st.floats(-5, 5))
def test_samples_do_not_depend_on_place_and_heading(heading, shift):
    frames = walker("walk", 3.0).frames
    count = frames.batch_shape
    moved = state.move(frames, np.full(count, heading), np.tile([shift, -shift, 0.0], (*count, 1)))
    at = np.array([30, 90])
    here, there = windows_around(path_of(frames), at), windows_around(path_of(moved), at)
    assert np.allclose(here.pos_h, there.pos_h, atol=1e-9)
    assert np.allclose(here.facing_h, there.facing_h, atol=1e-9)
