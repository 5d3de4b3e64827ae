"""Which keys are held, as far as a terminal tells: it sends a key when it is pressed, and then repeats.

A terminal never says that a key was released. The first repeat of a held key comes after 0.25 to 0.66 s, the
others every 30 ms or so. So a key that was pressed counts as held until the first repeat must have come, and
once it repeats for ``REPEAT_S`` after each. Of several held keys only the last repeats: the others stay held
with it.

How long to wait for the first repeat is measured, so that a tap is as short as this terminal allows:
``FIRST_S`` until two holds were seen, and then the longer of the last two waits with some slack.
"""

from __future__ import annotations

import math
from collections import deque

from unicon.schedulers.keyboard.key_table import OPPOSITES, Action

FIRST_S = 0.7
"""Longer than any terminal waits before it repeats."""
REPEAT_S = 0.15
SLACK_S = 0.06
"""A first repeat may come so much later than the one before."""
_QUICK_S = 0.1
_SURE = 3
"""So many quick repeats are a held key, not somebody who types fast."""


class HeldKeys:
    """The actions whose keys are held."""

    def __init__(self) -> None:
        self._pressed: dict[Action, float] = {}
        self._until = 0.0
        self._last: tuple[Action | None, float] = (None, 0.0)
        self._waits = deque([FIRST_S, FIRST_S], maxlen=2)
        self._wait, self._quick = math.inf, 0

    @property
    def first_s(self) -> float:
        """For so long a key counts as held that was pressed once."""
        return min(FIRST_S, max(self._waits) + SLACK_S)

    def press(self, action: Action, time_s: float) -> None:
        """Take in that the key of an action came, for the first time or again."""
        self._measure(action, time_s)
        self._pressed = self._pressed if time_s < self._until else {}
        for pair in OPPOSITES:
            if action in pair:
                self._pressed = {
                    key: at for key, at in self._pressed.items() if key not in pair or key is action
                }
        first = self._pressed.setdefault(action, time_s)
        # a byte that comes soon after the press may be a second tap: the wait for a repeat goes on
        self._until = max(first + self.first_s, time_s + REPEAT_S)

    def held(self, time_s: float) -> set[Action]:
        """Return the actions whose keys are held at a time."""
        return set(self._pressed) if time_s < self._until else set()

    def release(self) -> None:
        """Let go of all."""
        self._pressed = {}

    def _measure(self, action: Action, time_s: float) -> None:
        """Learn the wait: the last long gap before a row of quick repeats."""
        last, last_s = self._last
        gap = time_s - last_s if action is last else math.inf
        self._last = action, time_s
        if gap > _QUICK_S:
            self._wait, self._quick = gap, 0
            return
        self._quick += 1
        if self._quick == _SURE and self._wait <= FIRST_S:
            self._waits.append(self._wait)
