"""How well a character does what it is told: speeds, headings and feet, over the steady part of each stage.

The first ``SETTLE_S`` of a stage are left out. Velocities are means over the rest of a stage, in the
heading frame, so that the sway of single steps is none:

    velocity error = |mean achieved - commanded| / max(|commanded|, 0.3 m/s)   [%], of stages that go
    heading error  = |turned - commanded turn| over the steady part            [deg]
    foot slide     = mean speed of the point of contact of feet that stand     [cm/s]

Whether a foot stands is found as in the motion library (`unicon.motion.grounding.contact`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from unicon import rotations
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import ContactConfig, Soles, find_contacts
from unicon.schedulers.keyboard.drive import Stage
from unicon.state import CharacterState

SETTLE_S = 2.0
_LEAST_M_S = 0.3
_LEAST_FRAMES = 30


class StageResult(NamedTuple):
    """How a stage went."""

    name: str
    commanded_h: tuple[float, float]
    """[m/s]."""
    achieved_h: tuple[float, float]
    """Mean of the steady part [m/s]."""
    commanded_turn: float
    """[rad/s]."""
    achieved_turn: float
    """Mean of the steady part [rad/s]."""
    velocity_error_percent: float
    heading_error_deg: float


class DriveResult(NamedTuple):
    """How a drive went."""

    stages: tuple[StageResult, ...]
    velocity_error_percent: float
    """Median over the stages that go."""
    heading_error_deg: float
    """Median over all stages."""
    slide_standing_cm_s: float
    """Mean over the steady part of stages that stand."""
    slide_moving_cm_s: float
    """Mean over the steady part of stages that go."""


def measure_drive(frames: CharacterState, stages: list[Stage], first_s: float = 0.0) -> DriveResult:
    """Return how the frames ``(T,)`` at 60 Hz follow the commands of a drive.

    Args:
        frames: of the reference or of the simulated avatar.
        stages: of the drive.
        first_s: when the first stage begins, in the time of the frames.
    """
    heading = np.unwrap(rotations.heading_angle(frames.root_quat_w))
    soles = Soles(forward_kinematics(frames))
    contact = find_contacts(soles, frames.root_pos_w, ContactConfig())
    slides = np.where(contact, 100.0 * soles.speeds(), np.nan)
    results, standing, moving = [], [], []
    begin_s = first_s
    for stage in stages:
        steady = _steady(begin_s, stage.seconds, len(heading))
        begin_s += stage.seconds
        if steady.stop - steady.start < _LEAST_FRAMES:
            continue
        results.append(_measure_stage(stage, frames.root_pos_w[steady, :2], heading[steady]))
        (standing if stage.command.stands else moving).append(slides[steady].ravel())
    going = [result.velocity_error_percent for result in results if np.any(result.commanded_h)]
    return DriveResult(
        tuple(results),
        float(np.median(going)) if going else float("nan"),
        float(np.median([result.heading_error_deg for result in results])),
        _mean(standing),
        _mean(moving),
    )


def _steady(begin_s: float, seconds: float, count: int) -> slice:
    """Return the frames of a stage's steady part; of a short one its last half."""
    settle_s = min(SETTLE_S, 0.5 * seconds)
    first = round((begin_s + settle_s) * RATE_HZ)
    last = round((begin_s + seconds) * RATE_HZ)
    return slice(min(first, count), max(min(first, count), min(last, count)))


def _measure_stage(stage: Stage, pos_w: np.ndarray, heading: np.ndarray) -> StageResult:
    steps = np.diff(pos_w, axis=0) * RATE_HZ
    middle = 0.5 * (heading[1:] + heading[:-1])
    cos, sin = np.cos(middle), np.sin(middle)
    forward = float(np.mean(cos * steps[:, 0] + sin * steps[:, 1]))
    left = float(np.mean(cos * steps[:, 1] - sin * steps[:, 0]))
    seconds = (len(heading) - 1) / RATE_HZ
    turned = float(heading[-1] - heading[0])
    wanted = stage.command.velocity_h
    off = float(np.hypot(forward - wanted[0], left - wanted[1]))
    return StageResult(
        name=stage.name,
        commanded_h=wanted,
        achieved_h=(forward, left),
        commanded_turn=stage.command.turn_rate,
        achieved_turn=turned / seconds,
        velocity_error_percent=100.0 * off / max(stage.command.speed, _LEAST_M_S),
        heading_error_deg=float(np.degrees(abs(turned - stage.command.turn_rate * seconds))),
    )


def _mean(slides: list[np.ndarray]) -> float:
    values = np.concatenate(slides) if slides else np.array([np.nan])
    return float(np.nanmean(values)) if np.isfinite(values).any() else float("nan")
