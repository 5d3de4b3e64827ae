"""Makes a motion's contact with the ground one that physics can follow.

1. Height: the lowest point on the floor, flights in free fall (floor.py, flight.py).
2. Root: the horizontal path scaled so that standing feet rest (root_scale.py).
3. Feet: found in contact (contact.py), laid flat (levelling.py), held still and on the floor (planting.py,
   leg_ik.py), toes bent so that they lie on it (toes.py).

Nothing is filtered: every change is added to the motion, and is itself smooth, so that the ends of a clip
stay as fast as its middle.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import ContactConfig, Soles, find_contacts
from unicon.motion.grounding.flight import FlightConfig, air_frames, find_flights
from unicon.motion.grounding.floor import FloorConfig, height_change
from unicon.motion.grounding.leg_ik import SIDES, leg_of, missing_reach, move_foot
from unicon.motion.grounding.levelling import LevellingConfig, level_feet
from unicon.motion.grounding.planting import PlantingConfig, foot_shift, root_drop
from unicon.motion.grounding.root_scale import RootScaleConfig, scale_path, stance_ratio
from unicon.motion.grounding.solid_shapes import lowest_height, lowest_point, mass_centre
from unicon.motion.grounding.toes import bend_toes, highest_tips
from unicon.state import CharacterState, differentiate

__all__ = ["GroundConfig", "Grounded", "ground", "height_correction", "lowest_point"]

_TOES = ("left_toe", "right_toe")


@dataclass(frozen=True)
class GroundConfig:
    """How a motion is put on the ground."""

    flight: FlightConfig = field(default_factory=FlightConfig)
    floor: FloorConfig = field(default_factory=FloorConfig)
    contact: ContactConfig = field(default_factory=ContactConfig)
    root_scale: RootScaleConfig = field(default_factory=RootScaleConfig)
    levelling: LevellingConfig = field(default_factory=LevellingConfig)
    planting: PlantingConfig = field(default_factory=PlantingConfig)


class Grounded(NamedTuple):
    """A motion on the ground."""

    frames: CharacterState
    """Batch ``(T,)`` at 60 Hz."""
    contact: np.ndarray
    """When the left and the right foot stand ``(T, 2)``."""
    air: np.ndarray
    """When the body is in flight ``(T,)``."""
    root_scale: float
    """By what the root's horizontal path was scaled."""


def ground(frames: CharacterState, config: GroundConfig = GroundConfig()) -> Grounded:  # noqa: B008 - frozen
    """Return a motion ``(T,)`` at 60 Hz on the ground, wherever its floor was before."""
    placed = _place(frames, config)
    soles = Soles(placed.bodies, config.contact.roll_m)
    level = level_feet(frames.joint_pos, soles, placed.contact, config.levelling)
    placed = _place(replace(frames, joint_pos=level), config)
    drop, shift = _plan_planting(placed.bodies, placed.contact, config)
    root_pos = placed.bodies.pos_w[:, 0] - drop[:, None] * np.array([0.0, 0.0, 1.0])
    bodies = _moved(placed.bodies, root_pos)
    joint_pos = level
    for foot, side in enumerate(SIDES):
        joint_pos = move_foot(joint_pos, bodies, side, shift[:, foot])
    planted = replace(frames, root_pos_w=root_pos, joint_pos=joint_pos)
    joint_pos = bend_toes(joint_pos, forward_kinematics(planted))
    moved = differentiate(root_pos, frames.root_quat_w, joint_pos, RATE_HZ)
    return Grounded(moved, placed.contact, placed.air, placed.root_scale)


class _Placed(NamedTuple):
    """Poses on the floor, with the path of the root scaled, but the feet not yet held."""

    bodies: BodyKinematics
    contact: np.ndarray
    air: np.ndarray
    root_scale: float


def _place(frames: CharacterState, config: GroundConfig) -> _Placed:
    bodies = forward_kinematics(frames)
    lowest = np.minimum(lowest_height(bodies, but=_TOES), highest_tips(bodies).min(axis=1))
    mass_height = mass_centre(bodies)[:, 2]
    flights = find_flights(mass_height, lowest, config.flight)
    air = air_frames(flights, len(lowest))
    root_pos = frames.root_pos_w.copy()
    root_pos[:, 2] += height_change(lowest, mass_height, flights, config.floor)
    scale, contact = _scale_and_contacts(_moved(bodies, root_pos), root_pos, air, config)
    return _Placed(_moved(bodies, scale_path(root_pos, scale)), contact, air, scale)


def _moved(bodies: BodyKinematics, root_pos_w: np.ndarray) -> BodyKinematics:
    return replace(bodies, pos_w=bodies.pos_w + (root_pos_w - bodies.pos_w[:, 0])[:, None])


def _scale_and_contacts(
    bodies: BodyKinematics, root_pos_w: np.ndarray, air: np.ndarray, config: GroundConfig
) -> tuple[float, np.ndarray]:
    """Return the scale of the root's path, and the contacts ``(T, 2)`` after it.

    Either follows from the other: contacts found without a scale give a first one.
    """
    scale, contact = 1.0, np.zeros((len(air), 2), dtype=bool)
    for _ in range(3):
        path = scale_path(root_pos_w, scale)
        soles = Soles(_moved(bodies, path), config.contact.roll_m)
        contact = find_contacts(soles, path, config.contact) & ~air[:, None]
        ratio = stance_ratio(soles, contact, path, config.root_scale)
        if ratio is None:
            return scale, contact
        scale = float(np.clip(scale * ratio, config.root_scale.smallest, config.root_scale.largest))
    return scale, contact


def _plan_planting(
    bodies: BodyKinematics, contact: np.ndarray, config: GroundConfig
) -> tuple[np.ndarray, np.ndarray]:
    """Return by how much the root sinks ``(T,)`` and each ankle is shifted ``(T, 2, 3)`` [m]."""
    soles = Soles(bodies, config.contact.roll_m)
    heights = np.minimum(soles.heights, highest_tips(bodies))
    shift = foot_shift(soles.steps_w(), heights, contact, config.planting)
    missing = np.zeros(len(contact))
    for foot, side in enumerate(SIDES):
        leg = leg_of(side)
        lacks = missing_reach(bodies.pos_w[:, leg.thigh], bodies.pos_w[:, leg.foot], shift[:, foot])
        missing = np.maximum(missing, np.where(contact[:, foot], lacks, 0.0))
    drop = root_drop(missing, config.planting)
    return drop, foot_shift(soles.steps_w(), heights - drop[:, None], contact, config.planting)


def height_correction(lowest: np.ndarray) -> np.ndarray:
    """Return what to add to the root's height ``(T,)`` [m] of a motion without flights.

    As `floor.height_change`, but the lowest points ``(T,)`` are all that is known; what rises and falls
    as a body in flight does counts as one.
    """
    flights = find_flights(lowest, lowest, FlightConfig())
    return height_change(lowest, lowest, flights, FloorConfig())
