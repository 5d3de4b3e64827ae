"""Balls thrown at the avatar: how large, heavy and fast, where from and at which body.

A ball starts ``distance_m`` from the body it is aimed at, in the direction given by azimuth and elevation
relative to the avatar's heading, and flies at ``speed_m_s``. It is aimed a little high, so that gravity
brings it to where the body is now; the body may move meanwhile, as a person would.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass

import numpy as np

from unicon import rotations
from unicon.errors import UniconError, UnknownNameError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.state import CharacterState

GRAVITY_M_S2 = 9.81
MIN_HEIGHT_M = 0.05

LIMITS = {
    "mass_kg": (0.01, 100.0),
    "radius_m": (0.02, 0.5),
    "speed_m_s": (0.1, 50.0),
    "distance_m": (0.5, 10.0),
    "azimuth_rad": (-2 * np.pi, 2 * np.pi),
    "elevation_rad": (-np.pi / 2, np.pi / 2),
}


@dataclass(frozen=True)
class Projectile:
    """One throw.

    Raises:
        UniconError: when a value is out of its range.
        UnknownNameError: when there is no such body.
    """

    mass_kg: float = 1.0
    radius_m: float = 0.1
    speed_m_s: float = 10.0
    body: str = "chest"
    """Body it is aimed at."""
    azimuth_rad: float = 0.0
    """Where it comes from, from the avatar's forward direction to its left."""
    elevation_rad: float = 0.0
    """How far above the horizon it comes from."""
    distance_m: float = 2.0
    """How far from the body it starts."""

    def __post_init__(self) -> None:
        for name, (lower, upper) in LIMITS.items():
            value = getattr(self, name)
            if not lower <= value <= upper:
                raise UniconError(f"a projectile's {name} is {value}, expected {lower:g} to {upper:g}")
        if self.body not in HUMANOID.body_names:
            near = difflib.get_close_matches(self.body, HUMANOID.body_names, n=3, cutoff=0.0)
            raise UnknownNameError(f"there is no body {self.body!r}; the nearest are {', '.join(near)}")


@dataclass(frozen=True)
class Launch:
    """Where and how fast a ball starts."""

    pos_w: np.ndarray
    """``(3,)`` [m]."""
    vel_w: np.ndarray
    """``(3,)`` [m/s]."""


def aim(projectile: Projectile, avatar: CharacterState) -> Launch:
    """Return the start of a throw at the avatar's present pose."""
    bodies = forward_kinematics(avatar)
    goal_w = bodies.pos_w[HUMANOID.body_names.index(projectile.body)]
    cosine = np.cos(projectile.elevation_rad)
    towards_h = np.array(
        [
            cosine * np.cos(projectile.azimuth_rad),
            cosine * np.sin(projectile.azimuth_rad),
            np.sin(projectile.elevation_rad),
        ]
    )
    direction_w = rotations.rotate(rotations.heading(avatar.root_quat_w), towards_h)
    start_w = goal_w + projectile.distance_m * direction_w
    start_w[2] = max(start_w[2], projectile.radius_m + MIN_HEIGHT_M)
    path_w = goal_w - start_w
    flight_s = np.linalg.norm(path_w) / projectile.speed_m_s
    drop_w = np.array([0.0, 0.0, 0.5 * GRAVITY_M_S2 * flight_s])
    return Launch(start_w, path_w / flight_s + drop_w)


@dataclass(frozen=True)
class Barrage:
    """Balls thrown one after the other at bodies drawn evenly, from directions drawn evenly.

    A ball of 0.5 kg at 10 m/s brings 5 N s, which changes the speed of the avatar's 70 kg by 7 cm/s: one in
    80 ticks is a nudge, one in every tick a storm of 300 N from all sides.
    """

    every_ticks: int
    """How many ticks of 1/60 s lie between two throws; the first comes after as many."""
    mass_kg: float = 0.5
    radius_m: float = 0.08
    speed_m_s: float = 10.0
    distance_m: float = 1.0
    """How far from the body a ball starts."""
    max_elevation_rad: float = np.pi / 6
    """They come from between the horizon and so far above it."""
    lifetime_s: float = 0.2
    """How long a ball stays: twice the time of its flight."""

    def __post_init__(self) -> None:
        """Raise UniconError: when a number is out of its range."""
        if self.every_ticks < 1 or self.lifetime_s <= 0:
            raise UniconError(f"a barrage throws every {self.every_ticks} ticks, expected 1 or more")
        self.draw(np.random.default_rng(0))

    @property
    def balls(self) -> int:
        """How many balls are in the air at most."""
        return int(np.ceil((self.lifetime_s * 60 + 1) / self.every_ticks)) + 1

    def draw(self, rng: np.random.Generator) -> Projectile:
        """Return the next throw."""
        return Projectile(
            mass_kg=self.mass_kg,
            radius_m=self.radius_m,
            speed_m_s=self.speed_m_s,
            body=HUMANOID.body_names[rng.integers(len(HUMANOID.body_names))],
            azimuth_rad=rng.uniform(-np.pi, np.pi),
            elevation_rad=rng.uniform(0.0, self.max_elevation_rad),
            distance_m=self.distance_m,
        )
