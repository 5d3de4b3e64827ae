"""A scripted drive of two minutes: what a person does with the keys, at times that are known.

Walk, turn by 90 and 180 degrees both ways, jog, stop, step sideways and backward. A seed varies the durations
of all but the turns by up to 15 % against each other, and which side comes first.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from unicon.schedulers.keyboard.command import STAND, LocomotionCommand

WALK_M_S, JOG_M_S, BACK_M_S, SIDE_M_S = 1.2, 2.2, 0.7, 0.5
TURN_RAD_S = 0.9
DRIVE_S = 120.0
_VARIED = 0.15


class Stage(NamedTuple):
    """One command, held for a time."""

    name: str
    seconds: float
    command: LocomotionCommand


def scripted_drive(seed: int = 0) -> list[Stage]:
    """Return the stages of a drive; the same for the same seed."""
    rng = np.random.default_rng(seed)
    side = float(rng.choice([-1.0, 1.0]))
    walk = LocomotionCommand((WALK_M_S, 0.0))
    jog = LocomotionCommand((JOG_M_S, 0.0))
    back = LocomotionCommand((-BACK_M_S, 0.0))

    def turn(degrees: float, speed: float = WALK_M_S) -> Stage:
        seconds = math.radians(abs(degrees)) / TURN_RAD_S
        command = LocomotionCommand((speed, 0.0), math.copysign(TURN_RAD_S, degrees))
        return Stage(f"turn {degrees:+.0f}", seconds, command)

    def strafe(direction: float) -> Stage:
        return Stage("sideways", 4.0, LocomotionCommand((0.0, direction * SIDE_M_S)))

    stages = [
        Stage("stand", 3.0, STAND),
        Stage("walk", 7.0, walk),
        turn(90 * side),
        Stage("walk", 5.0, walk),
        turn(-90 * side),
        Stage("walk", 4.0, walk),
        Stage("stop", 4.0, STAND),
        Stage("walk", 4.0, walk),
        turn(180 * side),
        Stage("walk", 4.0, walk),
        turn(-180 * side),
        Stage("walk", 3.0, walk),
        Stage("jog", 7.0, jog),
        turn(90 * side, JOG_M_S),
        Stage("jog", 4.0, jog),
        Stage("walk", 4.0, walk),
        Stage("stop", 4.0, STAND),
        strafe(side),
        Stage("stop", 3.0, STAND),
        strafe(-side),
        Stage("stop", 3.0, STAND),
        Stage("backward", 5.0, back),
        Stage("stop", 3.0, STAND),
        Stage("turn on the spot", 3.0, LocomotionCommand((0.0, 0.0), side * TURN_RAD_S)),
        Stage("stop", 3.0, STAND),
        Stage("walk", 5.0, walk),
        Stage("jog", 5.0, jog),
        Stage("stop", 5.0, STAND),
    ]
    varied = [
        stage if _turns(stage) else stage._replace(seconds=_varied(stage.seconds, rng)) for stage in stages
    ]
    turning = drive_seconds([stage for stage in varied if _turns(stage)])
    stretch = (DRIVE_S - turning) / (drive_seconds(varied) - turning)
    return [stage if _turns(stage) else stage._replace(seconds=stretch * stage.seconds) for stage in varied]


def drive_seconds(stages: list[Stage]) -> float:
    """Return how long a drive takes [s]."""
    return sum(stage.seconds for stage in stages)


def command_at(stages: list[Stage], time_s: float) -> LocomotionCommand:
    """Return the command that is held at a time; standing before and after the drive."""
    for stage in stages:
        if time_s < stage.seconds:
            return stage.command if time_s >= 0.0 else STAND
        time_s -= stage.seconds
    return STAND


def _turns(stage: Stage) -> bool:
    """Whether its angle says how long it takes; all turns are kept as they are."""
    return stage.name.startswith("turn")


def _varied(seconds: float, rng: np.random.Generator) -> float:
    return float(seconds * rng.uniform(1.0 - _VARIED, 1.0 + _VARIED))
