"""Tests for target_buffer.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import START_NS, TICK_NS, message, standing
from unicon.state import CharacterState
from unicon.target_buffer import BufferConfig, TargetBuffer
from unicon.target_frames import TargetLimits, check


def moving(x: float, speed: float = 1.0) -> CharacterState:
    return CharacterState(**{**vars(standing(x)), "root_lin_vel_w": np.array([speed, 0.0, 0.0])})


def targets(time_ns: int, *states: CharacterState, interval_s: float = 0.1):
    return check(message(0, time_ns, *states, interval_s=interval_s), None, TargetLimits())


def x_at(buffer: TargetBuffer, *seconds: float) -> list[float]:
    times = np.array([START_NS + round(s * 1e9) for s in seconds])
    return buffer.sample(times).frames.root_pos_w[:, 0].tolist()


@pytest.fixture
def buffer() -> TargetBuffer:
    filled = TargetBuffer()
    filled.add(targets(START_NS, moving(0.0), moving(0.1), moving(0.2)))
    return filled


def test_a_frame_is_met_exactly_and_between_two_it_interpolates(buffer):
    assert np.allclose(x_at(buffer, 0.0, 0.05, 0.1, 0.17), [0.0, 0.05, 0.1, 0.17])


def test_past_the_last_frame_it_goes_on_for_fifty_milliseconds_and_then_holds(buffer):
    assert np.allclose(x_at(buffer, 0.24, 0.25, 0.3, 5.0), [0.24, 0.25, 0.25, 0.25])
    sample = buffer.sample(np.array([START_NS + 240_000_000, START_NS + 300_000_000]))
    assert sample.held.tolist() == [False, True]
    assert sample.frames.root_lin_vel_w[:, 0].tolist() == [1.0, 0.0]


def test_before_the_first_frame_it_holds_the_first(buffer):
    sample = buffer.sample(np.array([START_NS - TICK_NS]))
    assert sample.held.tolist() == [True]
    assert sample.frames.root_pos_w[0, 0] == 0.0
    assert not sample.frames.root_lin_vel_w.any()


def test_a_newer_message_replaces_everything_from_its_first_frame_on(buffer):
    buffer.add(targets(START_NS + 100_000_000, moving(1.0), moving(1.1)))
    assert np.allclose(x_at(buffer, 0.0, 0.1, 0.2), [0.0, 1.0, 1.1])


def test_an_older_message_takes_over_too(buffer):
    buffer.add(targets(START_NS - 1_000_000_000, moving(9.0)))
    assert len(buffer) == 1


def test_the_past_is_forgotten_while_time_goes_on():
    buffer = TargetBuffer()
    for k in range(1000):
        buffer.add(targets(START_NS + k * TICK_NS, moving(k / 60), moving((k + 1) / 60), interval_s=1 / 60))
        buffer.sample(np.array([START_NS + k * TICK_NS]))
    assert len(buffer) < 30


def test_frames_that_are_never_sampled_do_not_fill_the_memory():
    buffer = TargetBuffer(BufferConfig(max_frames=50))
    for k in range(300):
        buffer.add(targets(START_NS + k * TICK_NS, moving(0.0)))
    assert len(buffer) == 50


def test_an_empty_buffer_says_so():
    with pytest.raises(ValueError, match="empty"):
        TargetBuffer().sample(np.array([0]))
