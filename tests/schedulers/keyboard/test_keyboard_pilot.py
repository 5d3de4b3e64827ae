"""Tests for keyboard_pilot.py and key_table.py."""

from __future__ import annotations

import pytest

from unicon.schedulers.keyboard.key_table import TABLE, Action, action_of, banner
from unicon.schedulers.keyboard.keyboard_pilot import KeyboardPilot, PilotConfig

CONFIG = PilotConfig()


def pilot(*typed: str) -> KeyboardPilot:
    made = KeyboardPilot(CONFIG)
    for key in typed:
        made.press(action_of(key), 0.0)
    return made


def test_arrows_and_letters_do_the_same():
    assert action_of("up") is action_of("W") is Action.FORWARD
    assert action_of("left") is action_of("a") is Action.TURN_LEFT


def test_the_banner_names_every_key():
    for binding in TABLE:
        assert f"{', '.join(binding.keys)} " in banner()
        assert binding.action.value in banner()


@pytest.mark.parametrize(
    ("typed", "velocity", "turn"),
    [
        ("w", (CONFIG.walk_m_s, 0.0), 0.0),
        ("2w", (CONFIG.jog_m_s, 0.0), 0.0),
        ("3w", (CONFIG.run_m_s, 0.0), 0.0),
        ("s", (-CONFIG.back_m_s, 0.0), 0.0),
        ("q", (0.0, CONFIG.side_m_s), 0.0),
        ("wd", (CONFIG.walk_m_s, 0.0), -CONFIG.turn_rad_s),
        ("2s", (-CONFIG.back_m_s, 0.0), 0.0),
    ],
)
def test_keys_ask_for_velocities(typed, velocity, turn):
    command = pilot(*typed).command(0.1)
    assert command.velocity_h == pytest.approx(velocity)
    assert command.turn_rate == pytest.approx(turn)


def test_speed_keys_change_it_by_10_percent_within_bounds():
    assert pilot("+", "w").command(0.1).velocity_h[0] == pytest.approx(CONFIG.walk_m_s * 1.1)
    assert pilot("-", "w").command(0.1).velocity_h[0] == pytest.approx(CONFIG.walk_m_s / 1.1)
    assert pilot(*("+" * 50)).factor == 2.0
    assert pilot(*("-" * 50)).factor == 0.4


def test_any_other_key_stops_at_once():
    assert pilot("w", "x").command(0.01).stands
    assert pilot("w", " ").command(0.01).stands
