"""Tests for root_drift.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.motion.cleaning.figures import cleaned, figure, found, joined, lively, moved, turned


def sliding(count: int, speed: float):
    """Slide along, not quite steadily, with small movements."""
    t = np.arange(count) / 60
    way = speed * (t - t[-1] + 0.05 * np.sin(6.0 * t))
    motion = turned(figure(count), "neck", "y", 0.02 * np.sin(2.0 * t))
    return moved(motion, np.outer(way, [0.0, 1.0, 0.0]))


@pytest.mark.parametrize("speed", [0.1, 0.5])
def test_a_body_that_slides_as_a_whole_is_cut(speed):
    result = cleaned(joined(sliding(150, speed), lively(300)))
    (decision,) = result.decisions
    assert (decision.what, decision.reason, decision.first) == ("cut", "root_drift", 0)
    assert 145 <= decision.last <= 155 and "The whole body slides with" in decision.text
    assert 295 <= len(result.parts[0].times_s) <= 305


def test_what_something_carries_may_slide():
    assert ("cut", "root_drift") not in found(
        cleaned(joined(sliding(150, 0.5), lively(300)), context="Skateboard Motions")
    )


@pytest.mark.parametrize("steps_hz", [1.0, 2.0])
def test_legs_that_are_back_where_they_were_after_a_step_do_not_slide(steps_hz):
    t = np.arange(300) / 60
    motion = moved(figure(300), np.outer(4.0 * t, [1.0, 0.0, 0.0]))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        motion = turned(motion, f"{side}_hip", "y", sign * 0.6 * np.sin(2 * np.pi * steps_hz * t))
    assert ("cut", "root_drift") not in found(cleaned(motion))


def test_swaying_on_the_spot_is_no_drift():
    t = np.arange(600) / 60
    motion = moved(figure(600), np.outer(0.03 * np.sin(0.8 * t), [1.0, 0.0, 0.0]))
    assert ("cut", "root_drift") not in found(cleaned(turned(motion, "neck", "y", 0.05 * np.sin(2.0 * t))))
