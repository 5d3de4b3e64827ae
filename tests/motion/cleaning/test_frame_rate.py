"""Tests for frame_rate.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.motion.cleaning.figures import cleaned, found, lively, moved
from unicon.motion.cleaning.body_paths import body_paths
from unicon.motion.cleaning.frame_rate import falling, rate_evidence, walking_pace


def jumper(rate_hz: float, told_hz: float):
    """Three jumps of 0.3 m, captured at one rate and told to be at another."""
    count = int(6 * rate_hz)
    motion = lively(count, rate_hz, speed=0.3)
    airtime_s = np.sqrt(8 * 0.3 / 9.81)
    height = np.zeros(count)
    for start_s in (1.0, 3.0, 5.0):
        t = np.arange(count) / rate_hz - start_s
        height += np.where((t > 0) & (t < airtime_s), 0.5 * 9.81 * t * (airtime_s - t), 0.0)
    motion = moved(motion, np.outer(height, [0.0, 0.0, 1.0]))
    return replace(motion, times_s=np.arange(count) / told_hz)


def test_a_jump_falls_with_what_its_rate_makes_of_gravity():
    # Twice as fast: 4 x 9.81 = 39.2; half as fast: 2.45. The swinging limbs add a little.
    assert falling(body_paths(jumper(60.0, 60.0))) == pytest.approx(9.81, rel=0.15)
    assert falling(body_paths(jumper(60.0, 120.0))) == pytest.approx(39.2, rel=0.15)
    assert falling(body_paths(jumper(60.0, 30.0))) == pytest.approx(2.45, rel=0.15)
    assert falling(body_paths(lively(300))) is None


@pytest.mark.parametrize(
    ("told_hz", "says"), [(120.0, "so the rate is 60 Hz"), (30.0, "so the rate is 60 Hz")]
)
def test_a_wrong_rate_is_told_by_falling(told_hz, says):
    result = cleaned(jumper(60.0, told_hz))
    assert found(result) == [("resample", "frame_rate")]
    assert says in result.decisions[0].text and "m/s^2" in result.decisions[0].text
    assert np.allclose(np.diff(result.parts[0].times_s), 1 / 60)


def test_what_hangs_on_something_tells_nothing_by_falling():
    assert ("resample", "frame_rate") not in found(cleaned(jumper(60.0, 30.0), description="climb a ladder"))


def test_the_index_of_captures_is_believed_where_nothing_falls():
    motion = lively(600, 120.0, speed=0.2)
    result = cleaned(motion, capture_hz=60.0)
    assert found(result) == [("resample", "frame_rate")]
    assert "the file says 120 Hz, the index of captures 60 Hz" in result.decisions[0].text.replace(
        "The", "the", 1
    )
    assert np.allclose(np.diff(result.parts[0].times_s), 1 / 60)


def test_the_index_is_not_believed_against_what_falls_rightly():
    assert found(cleaned(jumper(120.0, 120.0), capture_hz=60.0)) == []


def test_a_file_thinned_out_from_a_faster_capture_is_right():
    assert found(cleaned(lively(300, 30.0), capture_hz=120.0)) == []


def walker(speed: float, steps_hz: float, rate_hz: float = 60.0, seconds: float = 6.0):
    """The paths of a walk: each foot stands half of the time and a bit more, then overtakes the body."""
    paths = body_paths(lively(int(seconds * rate_hz), rate_hz))
    t = paths.times_s
    pos_w = paths.pos_w.copy()
    pos_w[:, paths.parts["pelvis"], :2] = np.outer(t * speed, [1.0, 0.0])
    step = speed / steps_hz
    for side, offset in (("left", 0.0), ("right", 1.0)):
        phase = (t * steps_hz + offset) / 2.0
        swing = np.clip((phase % 1.0 - 0.55) / 0.45, 0.0, 1.0)
        along = 2.0 * step * (np.floor(phase) + swing * swing * (3.0 - 2.0 * swing))
        pos_w[:, paths.parts[f"{side}_foot"]] = np.outer(along - offset * step, [1.0, 0.0, 0.0])
    return replace(paths, pos_w=pos_w)


def test_the_pace_of_a_walk_is_measured():
    speed, steps_hz = walking_pace(walker(1.3, 1.9))
    assert speed == pytest.approx(1.3, abs=0.05)
    assert steps_hz == pytest.approx(1.9, abs=0.2)


def test_a_walk_at_double_speed_is_told_by_its_steps():
    assert rate_evidence(walker(1.3, 1.9)).factor is None
    evidence = rate_evidence(walker(2.6, 3.8))
    assert evidence.factor == 0.5 and "3.8 steps a second" in evidence.text
