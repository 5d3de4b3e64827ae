"""Which key does what: one table, from which the terminal program's banner is made as well."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple


class Action(Enum):
    """What a key asks for."""

    FORWARD = "go forward"
    BACKWARD = "go backward"
    TURN_LEFT = "turn left"
    TURN_RIGHT = "turn right"
    STEP_LEFT = "step to the left"
    STEP_RIGHT = "step to the right"
    WALK = "walk"
    JOG = "jog"
    RUN = "run"
    FASTER = "10 % faster"
    SLOWER = "10 % slower"
    STOP = "stop"


OPPOSITES = (
    (Action.FORWARD, Action.BACKWARD),
    (Action.TURN_LEFT, Action.TURN_RIGHT),
    (Action.STEP_LEFT, Action.STEP_RIGHT),
)
MOVES = frozenset(action for pair in OPPOSITES for action in pair)
"""Actions that last as long as their key is held."""


class Binding(NamedTuple):
    """Keys that do the same."""

    keys: tuple[str, ...]
    action: Action


TABLE = (
    Binding(("w", "up"), Action.FORWARD),
    Binding(("s", "down"), Action.BACKWARD),
    Binding(("a", "left"), Action.TURN_LEFT),
    Binding(("d", "right"), Action.TURN_RIGHT),
    Binding(("q",), Action.STEP_LEFT),
    Binding(("e",), Action.STEP_RIGHT),
    Binding(("1",), Action.WALK),
    Binding(("2",), Action.JOG),
    Binding(("3",), Action.RUN),
    Binding(("+", "="), Action.FASTER),
    Binding(("-",), Action.SLOWER),
)
_BY_KEY = {key: binding.action for binding in TABLE for key in binding.keys}


def action_of(key: str) -> Action:
    """Return what a key does; every key that is not in the table stops."""
    return _BY_KEY.get(key.lower(), Action.STOP)


def banner() -> str:
    """Return the table as people read it."""
    rows = [(", ".join(binding.keys), binding.action.value) for binding in TABLE]
    rows += [("any other key", Action.STOP.value), ("Ctrl-C", "quit")]
    width = max(len(keys) for keys, _ in rows)
    lines = [f"  {keys:<{width}}  {what}" for keys, what in rows]
    return "\n".join(["Steer the character; hold a key to keep going.", "", *lines, ""])
