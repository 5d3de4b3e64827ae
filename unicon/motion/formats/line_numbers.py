"""Errors at a line of a text file, and the numbers of that line."""

from __future__ import annotations

import math

from unicon.errors import InputFileError


class LineNumbers:
    """Where a reader of a text file is; readers derive from it."""

    def __init__(self, origin: str) -> None:
        self.origin = origin
        self.number = 0
        """Of the present line, from 1 on."""

    def fail(self, problem: str) -> InputFileError:
        """Return an error at the present line."""
        return InputFileError(f"{self.origin}, line {self.number}: {problem}")

    def numbers(self, words: list[str], count: int, what: str) -> list[float]:
        """Return ``count`` finite numbers.

        Raises:
            InputFileError: when the words are others.
        """
        if len(words) != count:
            raise self.fail(f"{what} has {len(words)} numbers, expected {count}")
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise self.fail(f"{what} holds something that is not a number") from None
        if not all(map(math.isfinite, values)):
            raise self.fail(f"{what} holds a number that is not finite")
        return values
