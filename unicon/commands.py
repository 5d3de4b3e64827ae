"""Everything besides target frames that changes an avatar's simulation.

Each command can be written as JSON and read back, so that a recording holds them in their order and the
whole run can be simulated again to the bit.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Literal

from unicon.errors import UniconError
from unicon.projectile import Projectile


@dataclass(frozen=True)
class Reset:
    """Start a new episode: in the rest pose at the origin, with all targets forgotten, or in the target."""

    to: Literal["rest", "target"] = "rest"


@dataclass(frozen=True)
class SelectSource:
    """Follow one source; empty for whichever began last."""

    source: str


@dataclass(frozen=True)
class LoadPolicy:
    """Replace the policy by a name or a folder."""

    policy: str


@dataclass(frozen=True)
class ThrowProjectile:
    """Throw a ball."""

    projectile: Projectile


Command = Reset | SelectSource | LoadPolicy | ThrowProjectile

KINDS: dict[str, type[Command]] = {
    "reset": Reset,
    "select_source": SelectSource,
    "load_policy": LoadPolicy,
    "throw_projectile": ThrowProjectile,
}
"""Each command by the name under which it is recorded."""


def kind_of(command: Command) -> str:
    """Return the name under which a command is recorded."""
    return next(kind for kind, cls in KINDS.items() if isinstance(command, cls))


def to_json(command: Command) -> str:
    """Return a command's arguments as a JSON object."""
    return json.dumps(asdict(command))


def from_json(kind: str, arguments: str) -> Command:
    """Read a command back.

    Raises:
        UniconError: when there is no such kind or the arguments do not fit it.
    """
    if kind not in KINDS:
        raise UniconError(f"there is no command {kind!r}; known are {', '.join(KINDS)}")
    try:
        values = json.loads(arguments)
        if kind == "throw_projectile":
            return ThrowProjectile(Projectile(**values["projectile"]))
        return KINDS[kind](**values)
    except (TypeError, KeyError, ValueError) as error:
        raise UniconError(f"the arguments {arguments!r} do not fit the command {kind!r}") from error
