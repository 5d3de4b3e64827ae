"""Tests for state_history.py."""

from __future__ import annotations

import numpy as np

from unicon.train.environment.state_history import StateHistory

SIZE = 197 + 206


def seen(*values: float) -> np.ndarray:
    """Inputs that hold one number everywhere."""
    return np.repeat(np.array(values, np.float32)[:, None], SIZE, axis=1)


def past_of(joined: np.ndarray) -> list[list[float]]:
    """The one number of each past state."""
    return joined[:, SIZE:].reshape(len(joined), -1, 197)[..., 0].tolist()


def test_the_first_state_stands_for_the_past_and_the_latest_comes_first():
    history = StateHistory(2, count=3)
    assert past_of(history.begin(seen(1, 2), np.array([0, 1]))) == [[1, 1, 1], [2, 2, 2]]
    assert past_of(history.follow(seen(3, 4))) == [[1, 1, 1], [2, 2, 2]]
    joined = history.follow(seen(5, 6))
    assert past_of(joined) == [[3, 1, 1], [4, 2, 2]]
    assert np.array_equal(joined[:, :SIZE], seen(5, 6))


def test_only_those_that_begin_anew_forget():
    history = StateHistory(2, count=2)
    history.begin(seen(1, 2), np.array([0, 1]))
    history.follow(seen(3, 4))
    assert past_of(history.begin(seen(9), np.array([1]))) == [[9, 9]]
    assert past_of(history.follow(seen(5, 6))) == [[3, 1], [9, 9]]


def test_without_a_past_nothing_is_added():
    history = StateHistory(2, count=0)
    inputs = seen(1, 2)
    assert history.follow(inputs) is inputs and history.begin(inputs, np.array([0, 1])) is inputs
    assert history.state() == {}


def test_a_restored_history_goes_on():
    one, two = StateHistory(1, 2), StateHistory(1, 2)
    one.begin(seen(1), np.array([0]))
    one.follow(seen(2))
    two.restore(one.state())
    assert np.array_equal(one.follow(seen(3)), two.follow(seen(3)))
