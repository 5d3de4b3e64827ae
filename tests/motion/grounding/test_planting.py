"""Tests for planting.py."""

from __future__ import annotations

import numpy as np

from unicon.motion.grounding.planting import PlantingConfig, foot_shift, root_drop

CONFIG = PlantingConfig()
COUNT = 90


def shift_of(steps_x: np.ndarray, heights: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Return the left foot's shift ``(T, 3)``."""
    steps = np.zeros((COUNT - 1, 2, 3))
    steps[:, 0, 0] = steps_x
    both = np.stack([contact, np.zeros_like(contact)], axis=1)
    return foot_shift(steps, np.stack([heights, np.full(COUNT, 0.1)], axis=1), both, CONFIG)[:, 0]


def stretch(start: int, stop: int) -> np.ndarray:
    return (np.arange(COUNT) >= start) & (np.arange(COUNT) < stop)


def test_a_foot_that_rests_is_not_shifted():
    shift = shift_of(np.zeros(COUNT - 1), np.zeros(COUNT), stretch(0, COUNT))
    assert np.allclose(shift, 0.0, atol=1e-9)


def test_a_slipping_foot_is_held():
    contact = stretch(30, 60)
    steps = np.where(contact[1:] & contact[:-1], 0.005, 0.0)
    shift = shift_of(steps, np.zeros(COUNT), contact)
    left = (np.diff(shift[:, 0]) + steps)[31:58]
    assert np.abs(left).mean() < 0.0005
    assert abs(shift[45, 0]) < 0.01


def test_the_shift_comes_and_goes_without_a_jump():
    contact = stretch(30, 60)
    steps = np.where(contact[1:] & contact[:-1], 0.005, 0.0)
    shift = shift_of(steps, np.where(contact, 0.02, 0.1), contact)
    assert np.abs(np.diff(shift, axis=0)).max() < 0.0075
    assert np.abs(np.diff(shift, 2, axis=0)).max() < 0.004


def test_no_foot_is_shifted_further_than_allowed():
    shift = shift_of(np.full(COUNT - 1, 0.02), np.zeros(COUNT), stretch(0, COUNT))
    assert np.linalg.norm(shift[:, :2], axis=1).max() < CONFIG.largest_shift_m


def test_a_standing_foot_is_on_the_floor():
    contact = stretch(20, 70)
    shift = shift_of(np.zeros(COUNT - 1), np.full(COUNT, 0.03), contact)
    assert np.allclose(shift[30:60, 2], -0.03, atol=0.002)


def test_a_swinging_foot_below_the_floor_is_lifted_and_one_above_is_not_lowered():
    sunk = stretch(30, 60)
    shift = shift_of(np.zeros(COUNT - 1), np.where(sunk, -0.03, 0.05), stretch(0, 0))
    assert np.allclose(shift[38:52, 2], 0.03, atol=0.004)
    assert np.all(shift[:, 2] > -0.005)


def test_the_root_sinks_as_far_as_a_leg_needs_and_comes_up_again():
    missing = np.where(stretch(40, 50), 0.03, 0.0)
    drop = root_drop(missing, CONFIG)
    assert drop[40:50].min() > 0.02
    assert drop.max() < 0.04
    assert drop[0] < 0.005
    assert np.all(drop >= 0.0)


def test_the_root_sinks_no_further_than_allowed():
    assert root_drop(np.full(COUNT, 0.5), CONFIG).max() <= CONFIG.largest_drop_m + 1e-9
