"""What a comparison compares: recipes, and switches that leave out one part of the method.

``laptop+no-rsis`` is the recipe ``laptop`` without reactive state initialisation; after a + a setting is as
good, ``laptop+ppo.epochs=1``, and there may be several.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from unicon.errors import UnknownNameError
from unicon.train.runs.recipe import Recipe, read_recipe

SWITCHES: dict[str, tuple[str, ...]] = {
    # every frame of the data as likely a start; failures still weigh
    "no-balancer": ("environment.balancer=false",),
    # a start before a failing section is no likelier
    "no-failures": ("environment.failure_cap=1.0",),
    # the deviation of the noise is learned by gradient
    "no-variance-controller": ("variance.mode=learned",),
    # an episode ends only with its clip or its time
    "no-constraint": ("environment.constraint=false",),
    # episodes begin in the target's own state
    "no-rsis": (
        "environment.rsis_share=0.0",
        "environment.position_noise_m=0.0",
        "environment.height_noise_m=0.0",
        "environment.joint_noise_rad=0.0",
        "environment.velocity_noise=0.0",
    ),
}
"""Settings by the name of what they leave out (paper, section 8.4)."""


@dataclass(frozen=True)
class Candidate:
    """One of those that are compared."""

    name: str
    """As it was asked for; also the name of its folder."""
    recipe: Recipe


def read_candidate(text: str, changes: Sequence[str] = ()) -> Candidate:
    """Read a recipe with switches.

    Args:
        text: such as "laptop", "mine.yaml" or "laptop+no-rsis+ppo.epochs=1".
        changes: settings of all candidates, as ``read_recipe`` takes them; switches come after them.

    Raises:
        UnknownNameError: when there is no such recipe or switch.
        InputFileError: when a setting is none.
    """
    recipe, *switches = text.split("+")
    settings = [setting for switch in switches for setting in _settings_of(switch, text)]
    name = re.sub(r"[^\w.+=-]", "_", text.removesuffix(".yaml"))
    return Candidate(name, read_recipe(recipe, (*changes, *settings)))


def _settings_of(switch: str, text: str) -> tuple[str, ...]:
    if "=" in switch:
        return (switch,)
    if switch not in SWITCHES:
        known = ", ".join(SWITCHES)
        raise UnknownNameError(
            f"{text}: there is no switch {switch!r}; known are {known}, or a setting such as ppo.epochs=1"
        )
    return SWITCHES[switch]
