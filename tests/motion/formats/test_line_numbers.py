"""Tests for line_numbers.py."""

from __future__ import annotations

import pytest

from unicon.errors import InputFileError
from unicon.motion.formats.line_numbers import LineNumbers


def at_line_seven() -> LineNumbers:
    lines = LineNumbers("walk.bvh")
    lines.number = 7
    return lines


def test_numbers_are_read():
    assert at_line_seven().numbers(["1", "-2.5", "3e-2"], 3, "OFFSET") == [1.0, -2.5, 0.03]


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["1"], "OFFSET has 1 numbers, expected 2"),
        (["1", "x"], "OFFSET holds something that is not a number"),
        (["1", "inf"], "OFFSET holds a number that is not finite"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(words, problem):
    with pytest.raises(InputFileError, match=f"walk.bvh, line 7: {problem}"):
        at_line_seven().numbers(words, 2, "OFFSET")
