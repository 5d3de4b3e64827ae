"""Tests for observation_variants.py."""

from __future__ import annotations

import pytest

from unicon.errors import UniconError
from unicon.train.environment.observation_variants import parse_variant


@pytest.mark.parametrize(
    ("name", "stride", "future", "past", "size"),
    [
        ("tau-1", 1, (1,), 0, 197 + 206),
        ("tau-1", 2, (2,), 0, 197 + 206),
        ("tau-3", 2, (2, 4, 6), 0, 197 + 3 * 206),
        ("lookahead-5", 1, (5,), 0, 197 + 206),
        ("stack-4", 2, (2,), 4, 197 + 206 + 4 * 197),
        ("frames-0-4-16-64", 1, (0, 4, 16, 64), 0, 197 + 4 * 206),
    ],
)
def test_a_name_says_which_frames_are_seen(name, stride, future, past, size):
    variant = parse_variant(name, stride)
    assert (variant.future, variant.past, variant.size) == (future, past, size)


@pytest.mark.parametrize("name", ["targets-only", "phase-onehot", "phase-number"])
def test_the_baselines_views_are_of_the_next_target_frame(name):
    assert parse_variant(name, 2) == ((2,), 0, name)
    assert parse_variant("tau-1", 2).view == "whole"


def test_a_servo_aims_at_the_nearest_frame_to_come():
    assert parse_variant("frames-0-4-16-64", 1).nearest == 4
    assert parse_variant("lookahead-3", 2).nearest == 6
    assert parse_variant("frames-0", 1).nearest == 1


@pytest.mark.parametrize(
    "name",
    [
        "",
        "tau",
        "tau-0",
        "tau-9",
        "tau-1-2",
        "tau--1",
        "lookahead-0",
        "stack-0",
        "frames-",
        "frames-4-4",
        "x-1",
        "phase-1",
        "whole",
    ],
)
def test_other_names_are_refused_with_those_that_there_are(name):
    with pytest.raises(UniconError, match="tau-1 to tau-8, lookahead-k"):
        parse_variant(name, 1)


def test_a_stride_is_at_least_one_frame():
    with pytest.raises(UniconError, match="stride is 0"):
        parse_variant("tau-1", 0)
