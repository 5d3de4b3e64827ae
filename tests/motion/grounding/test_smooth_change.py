"""Tests for smooth_change.py."""

from __future__ import annotations

import numpy as np

from unicon.motion.grounding.smooth_change import SmoothChange, smooth_cover, spans


def test_two_values_and_a_step_are_weighed_by_hand():
    # (x0 - 0)^2 + (x1 - 0)^2 + 2 (x1 - x0 - 5)^2 is least at x1 = -x0 = 2.
    problem = SmoothChange(2)
    problem.want_values(1.0, 0.0)
    problem.want_steps(2.0, 5.0)
    assert np.allclose(problem.solve()[:, 0], [-2.0, 2.0])


def test_three_values_and_a_bend_are_weighed_by_hand():
    # 2 a^2 + (b - 3)^2 + (2 a - 2 b)^2 is least at a = 6/7, b = 9/7.
    problem = SmoothChange(3)
    problem.want_values(1.0, np.array([0.0, 3.0, 0.0]))
    problem.want_bends(1.0, 0.0)
    assert np.allclose(problem.solve()[:, 0], [6 / 7, 9 / 7, 6 / 7])


def test_it_agrees_with_dense_least_squares():
    random = np.random.default_rng(1)
    count = 9
    weights = [random.uniform(0.1, 2.0, count - k) for k in range(3)]
    wanted = [random.normal(size=(count - k, 2)) for k in range(3)]
    problem = SmoothChange(count, 2)
    problem.want_values(weights[0], wanted[0])
    problem.want_steps(weights[1], wanted[1])
    problem.want_bends(weights[2], wanted[2])
    rows = np.concatenate(
        [np.diff(np.eye(count), k, axis=0) * np.sqrt(weights[k])[:, None] for k in range(3)]
    )
    right = np.concatenate([wanted[k] * np.sqrt(weights[k])[:, None] for k in range(3)])
    assert np.allclose(problem.solve(), np.linalg.lstsq(rows, right, rcond=None)[0])


def test_a_slope_goes_on_as_it_is_to_the_very_ends():
    line = np.linspace(0.0, 5.0, 50)
    problem = SmoothChange(50)
    problem.want_values(1.0, line)
    problem.want_bends(1000.0, 0.0)
    assert np.allclose(problem.solve()[:, 0], line)


def test_a_cover_is_hardly_below_and_not_far_above():
    wanted = np.zeros(100)
    wanted[45:55] = 1.0
    cover = smooth_cover(wanted, 10.0)
    assert (wanted - cover).max() < 0.3
    assert cover.max() < 1.2
    assert np.abs(np.diff(cover)).max() < 0.2


def test_spans_are_found_at_both_ends():
    assert spans(np.array([True, True, False, True, False, True])) == [(0, 2), (3, 4), (5, 6)]
    assert spans(np.zeros(3, dtype=bool)) == []
