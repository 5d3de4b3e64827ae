"""Tests for held_keys.py."""

from __future__ import annotations

import pytest

from unicon.schedulers.keyboard.held_keys import FIRST_S, REPEAT_S, SLACK_S, HeldKeys
from unicon.schedulers.keyboard.key_table import Action


def hold(keys: HeldKeys, action: Action, first_s: float, seconds: float, wait_s: float = 0.5) -> float:
    """Press and hold a key as a terminal tells it; return when its last byte came."""
    keys.press(action, first_s)
    time_s = first_s + wait_s
    while time_s <= first_s + seconds:
        keys.press(action, time_s)
        time_s += 0.033
    return time_s - 0.033


def test_a_tap_is_a_short_step():
    keys = HeldKeys()
    keys.press(Action.FORWARD, 10.0)
    assert keys.held(10.0 + FIRST_S - 0.01) == {Action.FORWARD}
    assert keys.held(10.0 + FIRST_S) == set()


@pytest.mark.parametrize("wait_s", [0.25, 0.5, 0.66])
def test_a_held_key_is_held_without_a_gap_whatever_the_wait_for_its_first_repeat(wait_s):
    keys = HeldKeys()
    keys.press(Action.FORWARD, 0.0)
    time_s, next_s = 0.0, wait_s
    while time_s < 3.0:
        if time_s >= next_s:
            keys.press(Action.FORWARD, time_s)
            next_s += 0.033
        assert keys.held(time_s) == {Action.FORWARD}
        time_s += 0.005


def test_a_held_key_is_let_go_soon_after_its_last_repeat():
    keys = HeldKeys()
    last_s = hold(keys, Action.FORWARD, 0.0, 2.0)
    assert keys.held(last_s + REPEAT_S - 0.01)
    assert not keys.held(last_s + REPEAT_S)


def test_the_first_of_two_held_keys_stays_held_though_only_the_second_repeats():
    keys = HeldKeys()
    hold(keys, Action.FORWARD, 0.0, 1.0)
    last_s = hold(keys, Action.TURN_LEFT, 1.05, 2.0)
    assert keys.held(last_s) == {Action.FORWARD, Action.TURN_LEFT}
    assert not keys.held(last_s + REPEAT_S)


def test_the_opposite_key_takes_over():
    keys = HeldKeys()
    hold(keys, Action.FORWARD, 0.0, 1.0)
    keys.press(Action.BACKWARD, 1.05)
    assert keys.held(1.06) == {Action.BACKWARD}


def test_letting_go_is_at_once():
    keys = HeldKeys()
    keys.press(Action.FORWARD, 0.0)
    keys.release()
    assert not keys.held(0.01)


def test_after_two_holds_a_tap_is_as_short_as_the_terminal_allows():
    keys = HeldKeys()
    hold(keys, Action.FORWARD, 0.0, 1.0, wait_s=0.25)
    assert keys.first_s == FIRST_S
    hold(keys, Action.TURN_LEFT, 5.0, 1.0, wait_s=0.27)
    assert keys.first_s == pytest.approx(0.27 + SLACK_S)
    keys.press(Action.FORWARD, 10.0)
    assert keys.held(10.32)
    assert not keys.held(10.34)


def test_a_single_stall_of_the_line_does_not_shorten_the_wait():
    keys = HeldKeys()
    hold(keys, Action.FORWARD, 0.0, 1.0, wait_s=0.5)
    last_s = hold(keys, Action.FORWARD, 5.0, 1.0, wait_s=0.5)
    hold(keys, Action.FORWARD, last_s, 1.0, wait_s=0.3)
    assert keys.first_s == pytest.approx(0.5 + SLACK_S)


def test_a_longer_wait_is_learned_again():
    keys = HeldKeys()
    for start_s in (0.0, 5.0):
        hold(keys, Action.FORWARD, start_s, 1.0, wait_s=0.25)
    hold(keys, Action.FORWARD, 10.0, 2.0, wait_s=0.5)
    assert keys.first_s == pytest.approx(0.5 + SLACK_S)


def test_fast_taps_teach_nothing():
    keys = HeldKeys()
    for time_s in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2):
        keys.press(Action.FORWARD, time_s)
    assert keys.first_s == FIRST_S
