"""Tests for phase_function.py."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.schedulers.pfnn.phase_function import control_weights

PHASES = st.floats(-20.0, 20.0)
KINDS = st.sampled_from(("cubic", "linear", "nearest"))


@pytest.mark.parametrize("kind", ["cubic", "linear", "nearest"])
def test_the_curve_passes_through_its_control_points(kind):
    phases = np.array([0.0, 0.5, 1.0, 1.5]) * math.pi
    assert control_weights(phases, 4, kind) == pytest.approx(np.eye(4), abs=1e-12)


def test_a_case_by_hand():
    # half way from the point 0 to the point 1 the Catmull-Rom spline is -1/16, 9/16, 9/16, -1/16
    weights = control_weights(np.array(math.pi / 4))
    assert weights == pytest.approx([9 / 16, 9 / 16, -1 / 16, -1 / 16])
    # a quarter of the way on from point 3 to point 0, by the paper's equation 7
    y0, y1, y2, y3 = np.eye(4)[[2, 3, 0, 1]]
    w = 0.25
    expected = (
        y1
        + w * (0.5 * y2 - 0.5 * y0)
        + w**2 * (y0 - 2.5 * y1 + 2 * y2 - 0.5 * y3)
        + w**3 * (1.5 * y1 - 1.5 * y2 + 0.5 * y3 - 0.5 * y0)
    )
    assert control_weights(np.array((3 + w) * math.pi / 2)) == pytest.approx(expected)


def test_linear_and_nearest_by_hand():
    phase = np.array(2 * math.pi * 10.25 / 50)
    linear = control_weights(phase, 50, "linear")
    assert (linear[10], linear[11], linear.sum()) == pytest.approx((0.75, 0.25, 1.0))
    assert np.flatnonzero(control_weights(phase, 50, "nearest")) == [10]
    last = np.array(2 * math.pi * 49.7 / 50)
    assert np.flatnonzero(control_weights(last, 50, "nearest")) == [0]


@given(PHASES, KINDS)
def test_the_weights_sum_to_one(phase, kind):
    assert control_weights(np.array(phase), 5, kind).sum() == pytest.approx(1.0)


@given(PHASES, st.integers(-3, 3))
def test_the_curve_is_closed(phase, turns):
    here = control_weights(np.array(phase))
    there = control_weights(np.array(phase + 2 * math.pi * turns))
    assert there == pytest.approx(here, abs=1e-9)


@given(st.integers(0, 3))
def test_the_derivative_is_continuous_at_the_control_points(point):
    at, step = point * math.pi / 2, 1e-5
    before, here, after = control_weights(at + np.array([-step, 0.0, step]))
    assert (here - before) / step == pytest.approx((after - here) / step, abs=1e-3)
    # and it is that of Catmull-Rom: half the difference of the points beside
    slope = np.zeros(4)
    slope[(point + 1) % 4], slope[(point - 1) % 4] = 1 / math.pi, -1 / math.pi
    assert (after - before) / (2 * step) == pytest.approx(slope, abs=1e-5)


@given(PHASES)
def test_more_phases_keep_their_order(phase):
    # a shift by one point's distance shifts the weights by one point
    step = 2 * math.pi / 7
    shifted = control_weights(np.array(phase + step), 7)
    assert shifted == pytest.approx(np.roll(control_weights(np.array(phase), 7), 1), abs=1e-9)
