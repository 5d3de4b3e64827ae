"""Keys out of what a terminal sends: characters as they are, other keys as escape sequences.

A sequence is ``ESC [``, numbers, a letter, or ``ESC O`` and a letter (ECMA-48, section 5.4). It may come in
pieces, over ssh for example, and none of its pieces may count as a key that was typed.
"""

from __future__ import annotations

import re

PATIENCE_S = 0.05
"""The rest of a sequence comes within this time; else somebody pressed Escape."""
_KEY = re.compile(r"\x1b(?:\[\[?[0-?]*[ -/]*[@-~]|O[@-~])|.", re.DOTALL)
_UNFINISHED = re.compile(r"\x1b(?:\[\[?[0-?]*[ -/]*|O)?\Z")
_ARROW = re.compile(r"\x1b(?:\[(?:1;\d+)?|O)([ABCD])")
_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}


class KeyReader:
    """Names the keys; an arrow with Shift, Ctrl or Alt is that arrow."""

    def __init__(self) -> None:
        self._rest, self._since_s = "", 0.0

    def read(self, typed: str, time_s: float) -> list[str]:
        """Return the keys that are complete with what was typed until a time; nothing may have been."""
        if not typed:
            return self._give_up(time_s)
        text = self._rest + typed
        unfinished = _UNFINISHED.search(text)
        self._rest, self._since_s = (unfinished.group() if unfinished else ""), time_s
        return [_name(found.group()) for found in _KEY.finditer(text[: len(text) - len(self._rest)])]

    def _give_up(self, time_s: float) -> list[str]:
        if not self._rest or time_s - self._since_s < PATIENCE_S:
            return []
        self._rest = ""
        return ["escape"]


def _name(sent: str) -> str:
    arrow = _ARROW.fullmatch(sent)
    if arrow:
        return _ARROWS[arrow.group(1)]
    return "escape" if sent.startswith("\x1b") else sent
