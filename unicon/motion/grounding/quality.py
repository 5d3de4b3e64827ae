"""How good a clip is: each figure by itself, with its unit in its name."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import BodyKinematics, forward_kinematics
from unicon.humanoid.table import ROOT_HEIGHT_M
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.flight import FlightConfig, air_frames, find_flights
from unicon.motion.grounding.root_scale import RootScaleConfig, stance_ratio
from unicon.motion.grounding.solid_shapes import lowest_height, mass_centre
from unicon.state import CharacterState

NOT_MEASURED = float("nan")

FLOATING_M = 0.06
NEAR_LIMIT_RAD = float(np.radians(0.5))
END_FRAMES = 5
SLOWEST = 0.3
"""Below this speed [m/s] at the ends, their ratio says nothing."""


@dataclass(frozen=True)
class ClipQuality:
    """Figures of one clip; not a number where there is nothing to measure."""

    mean_error_mm: float
    """Distance of our bodies from the scaled source's joints, both relative to the hips' middle: mean."""
    worst_error_mm: float
    """The largest such distance."""
    penetration_p99_mm: float
    """Depth of the lowest point below the floor, 99th percentile of the frames."""
    floating_share: float
    """Share of the frames in which the lowest point is more than 6 cm above the floor outside flights."""
    skate_mm_per_frame: float
    """Mean horizontal way of the point of contact from frame to frame while a foot stands."""
    contact_share: float
    """Share of the frames in which a foot stands."""
    limit_saturation: float
    """Share of all hinge angles, over the frames, that are within half a degree of a limit."""
    height_m: float
    """Median height of the pelvis, upright on a foot, over that of the rest pose, times 1.8 m."""
    flight_share: float
    """Share of the frames in flight."""
    flight_acceleration: float
    """Vertical acceleration of the centre of mass in flight, mean over the flights' frames [m/s^2]."""
    stance_ratio: float
    """Speed of the legs against standing feet over the root's speed; 1 where they agree."""
    max_body_ang_vel: float
    """Largest angular velocity of any body against the world [rad/s]."""
    max_joint_vel: float
    """Largest velocity of any hinge [rad/s]."""
    end_speed_ratio: float
    """Root's speed across at the first frame over that five frames on, or likewise at the end, if less."""

    def to_dict(self) -> dict[str, float]:
        """Return the figures by name."""
        return asdict(self)


def measure(
    frames: CharacterState,
    contact: np.ndarray,
    reference_pos: np.ndarray | None = None,
    reference_bodies: tuple[str, ...] = (),
) -> ClipQuality:
    """Measure a clip.

    Args:
        frames: batch ``(T,)`` at 60 Hz, on the floor z = 0.
        contact: when the left and the right foot stand ``(T, 2)``.
        reference_pos: the source's joints, scaled, relative to its hips' middle ``(T, K, 3)`` [m].
        reference_bodies: names of the K bodies whose origins these joints are.
    """
    bodies = forward_kinematics(frames)
    lowest, mass_height = lowest_height(bodies), mass_centre(bodies)[:, 2]
    air = air_frames(find_flights(mass_height, lowest, FlightConfig()), len(lowest))
    soles = Soles(bodies)
    errors_mm = _errors_mm(bodies, reference_pos, reference_bodies)
    ratio = stance_ratio(soles, contact, frames.root_pos_w, RootScaleConfig())
    return ClipQuality(
        mean_error_mm=float(errors_mm.mean()),
        worst_error_mm=float(errors_mm.max()),
        penetration_p99_mm=float(np.percentile(np.maximum(-lowest, 0.0), 99) * 1000),
        floating_share=float(np.mean((lowest > FLOATING_M) & ~air)),
        skate_mm_per_frame=_skate_mm(soles, contact),
        contact_share=float(contact.any(axis=1).mean()),
        limit_saturation=_saturation(frames.joint_pos),
        height_m=_height(bodies, contact),
        flight_share=float(air.mean()),
        flight_acceleration=_flight_acceleration(mass_height, air),
        stance_ratio=NOT_MEASURED if ratio is None else ratio,
        max_body_ang_vel=float(np.linalg.norm(bodies.ang_vel_w, axis=-1).max()),
        max_joint_vel=float(np.abs(frames.joint_vel).max()),
        end_speed_ratio=_end_speed_ratio(frames.root_lin_vel_w),
    )


def body_errors(
    bodies: BodyKinematics, reference_pos: np.ndarray, reference_bodies: tuple[str, ...]
) -> np.ndarray:
    """Return each body's distance ``(T, K)`` [m] from the reference, both relative to the hips' middle."""
    thighs = [HUMANOID.body_names.index(f"{side}_thigh") for side in ("left", "right")]
    chosen = [HUMANOID.body_names.index(name) for name in reference_bodies]
    ours = bodies.pos_w[:, chosen] - bodies.pos_w[:, thighs].mean(axis=1, keepdims=True)
    return np.linalg.norm(ours - reference_pos, axis=-1)


def _errors_mm(
    bodies: BodyKinematics, reference_pos: np.ndarray | None, reference_bodies: tuple[str, ...]
) -> np.ndarray:
    if reference_pos is None:
        return np.array([NOT_MEASURED])
    return 1000 * body_errors(bodies, reference_pos, reference_bodies)


def _skate_mm(soles: Soles, contact: np.ndarray) -> float:
    ways = np.linalg.norm(soles.steps_w()[..., :2], axis=-1)[contact[1:] & contact[:-1]]
    return float(1000 * ways.mean()) if len(ways) else NOT_MEASURED


def _saturation(joint_pos: np.ndarray) -> float:
    low = joint_pos < HUMANOID.joint_lower + NEAR_LIMIT_RAD
    high = joint_pos > HUMANOID.joint_upper - NEAR_LIMIT_RAD
    return float(np.mean(low | high))


def _height(bodies: BodyKinematics, contact: np.ndarray) -> float:
    upright = contact.any(axis=1) & (bodies.rot_w[:, 0, 2, 2] > np.cos(0.5))
    if not upright.any():
        return NOT_MEASURED
    return float(np.median(bodies.pos_w[upright, 0, 2]) / ROOT_HEIGHT_M * HUMANOID.height_m)


def _flight_acceleration(mass_height: np.ndarray, air: np.ndarray) -> float:
    inner = air[1:-1] & air[2:] & air[:-2]
    return float(np.diff(mass_height, 2)[inner].mean() * RATE_HZ**2) if inner.any() else NOT_MEASURED


def _end_speed_ratio(root_lin_vel_w: np.ndarray) -> float:
    speed = np.linalg.norm(root_lin_vel_w[:, :2], axis=-1)
    if len(speed) < 2 * END_FRAMES + 2 or min(speed[END_FRAMES], speed[-1 - END_FRAMES]) < SLOWEST:
        return NOT_MEASURED
    return float(min(speed[0] / speed[END_FRAMES], speed[-1] / speed[-1 - END_FRAMES]))
