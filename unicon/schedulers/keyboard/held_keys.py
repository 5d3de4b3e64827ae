"""Which keys are held, as far as a terminal tells: it sends a key when it is pressed, and then repeats.

A terminal never says that a key was released. The first repeat of a held key comes after 0.25 to 0.66 s, the
others every 30 ms or so. So a key that was pressed counts as held for ``FIRST_S``, which bridges the wait for
the first repeat, and once it repeats for ``REPEAT_S`` after each. Of several held keys only the last repeats:
the others stay held with it.
"""

from __future__ import annotations

from unicon.schedulers.keyboard.key_table import OPPOSITES, Action

FIRST_S = 0.7
REPEAT_S = 0.15


class HeldKeys:
    """The actions whose keys are held."""

    def __init__(self) -> None:
        self._pressed: dict[Action, float] = {}
        self._until = 0.0

    def press(self, action: Action, time_s: float) -> None:
        """Take in that the key of an action came, for the first time or again."""
        self._pressed = self._pressed if time_s < self._until else {}
        for pair in OPPOSITES:
            if action in pair:
                self._pressed = {
                    key: at for key, at in self._pressed.items() if key not in pair or key is action
                }
        first = self._pressed.setdefault(action, time_s)
        # a byte that comes soon after the press may be a second tap: the wait for a repeat goes on
        self._until = max(first + FIRST_S, time_s + REPEAT_S)

    def held(self, time_s: float) -> set[Action]:
        """Return the actions whose keys are held at a time."""
        return set(self._pressed) if time_s < self._until else set()

    def release(self) -> None:
        """Let go of all."""
        self._pressed = {}
