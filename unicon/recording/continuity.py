"""Proves by sequence numbers that a recording lost nothing, or says how much it lost.

The numbers are read straight from the serialised messages (CDR, little endian): alignment counts from
behind the four bytes of the header.
"""

from __future__ import annotations

import struct
from collections import Counter
from typing import NamedTuple

from unicon.errors import InputFileError

_HEADER = 4


class _Cursor:
    """Reads the fields of a serialised message in their order."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def _take(self, code: str, size: int) -> int:
        self._at += -self._at % size
        try:
            (value,) = struct.unpack_from("<" + code, self._data, _HEADER + self._at)
        except struct.error as error:
            raise InputFileError("a recorded message is shorter than its type") from error
        self._at += size
        return value

    def skip_header(self) -> None:
        """Pass a std_msgs/Header."""
        self._take("i", 4)
        self._take("I", 4)
        self.text()

    def text(self) -> str:
        """Return a string."""
        length = self._take("I", 4)
        start = _HEADER + self._at
        self._at += length
        return bytes(self._data[start : start + max(length - 1, 0)]).decode(errors="replace")

    def number(self) -> int:
        """Return a uint64."""
        return self._take("Q", 8)


class Gap(NamedTuple):
    """Messages that are missing."""

    stream: str
    expected: int
    found: int


class Continuity:
    """Counts the messages of the numbered streams and what is missing between them."""

    def __init__(self) -> None:
        self.received: Counter[str] = Counter()
        self.lost: Counter[str] = Counter()
        self._last: dict[str, int] = {}

    def see_state(self, data: bytes) -> Gap | None:
        """Take note of a CharacterState; return the gap before it, if there is one."""
        cursor = _Cursor(data)
        cursor.skip_header()
        return self._see("state", cursor.number())

    def see_targets(self, data: bytes) -> Gap | None:
        """Take note of a TargetFrames; return the gap before it, if there is one."""
        cursor = _Cursor(data)
        cursor.skip_header()
        source = cursor.text()
        return self._see(f"target_frames of {source[:64]}", cursor.number())

    def _see(self, stream: str, number: int) -> Gap | None:
        """A number that is not higher than the one before it begins a new run, as after a restart."""
        last = self._last.get(stream)
        self._last[stream] = number
        self.received[stream] += 1
        if last is None or number <= last + 1:
            return None
        self.lost[stream] += number - last - 1
        return Gap(stream, last + 1, number)

    def summary(self) -> dict[str, str]:
        """Return a line for each stream."""
        return {
            stream: f"{count} received, {self.lost[stream]} lost" for stream, count in self.received.items()
        }
