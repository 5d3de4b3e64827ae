"""Gives a source our proportions, part by part, as retargeters do with a scale for each body.

Legs are as long as ours already. The trunk, the breadth of the shoulders and the arms are scaled to ours
one by one, each with its own ratio of lengths in the rest pose. So a person with a long back has the hands
where they are for them, seen from the shoulders, and not where their height over the hips would put them.

    m' = k m                      m: middle of the shoulders, k: our trunk over the source's
    s' = m' + b (s - m)           s: a shoulder, b: breadth over breadth
    h' = m' + k (h - m)           h: where the head begins
    x' = s' + a (x - s)           x: elbow, wrist and fingertips, a: arm over arm

All positions are relative to the middle of the hips.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics

SIDES = ("left", "right")


def resize(places: Mapping[str, np.ndarray], rest: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return places ``(T, 3)`` by part with our proportions above the hips.

    Args:
        places: relative to the middle of the hips [m], legs as long as ours.
        rest: the same joints in the rest pose ``(3,)``, in any unit.
    """
    ours, theirs = _Lengths(_OURS), _Lengths(rest)
    leg = ours.leg / theirs.leg
    trunk = ours.trunk / (theirs.trunk * leg)
    breadth = ours.breadth / (theirs.breadth * leg)
    arm = ours.arm / (theirs.arm * leg)
    middle = 0.5 * (places["left_upper_arm"] + places["right_upper_arm"])
    resized = dict(places)
    if "head" in places:
        resized["head"] = trunk * places["head"]
    for side in SIDES:
        shoulder = places[f"{side}_upper_arm"]
        moved = trunk * middle + breadth * (shoulder - middle)
        for part in ("upper_arm", "forearm", "hand", "hand_tip"):
            name = f"{side}_{part}"
            if name in places:
                resized[name] = moved + arm * (places[name] - shoulder)
    return resized


class _Lengths:
    """Lengths of a skeleton at rest."""

    def __init__(self, rest: Mapping[str, np.ndarray]) -> None:
        hips = 0.5 * (rest["left_thigh"] + rest["right_thigh"])
        shoulders = 0.5 * (rest["left_upper_arm"] + rest["right_upper_arm"])
        self.trunk = _distance(hips, shoulders)
        self.breadth = _distance(rest["left_upper_arm"], rest["right_upper_arm"])
        self.arm = _along(rest, "upper_arm", "forearm", "hand")
        self.leg = _along(rest, "thigh", "shin", "foot")


def _along(rest: Mapping[str, np.ndarray], *parts: str) -> float:
    """Return the mean over both sides of the length of a chain of joints."""
    chains = [[rest[f"{side}_{part}"] for part in parts] for side in SIDES]
    return sum(_distance(a, b) for chain in chains for a, b in zip(chain, chain[1:], strict=False)) / 2


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.linalg.norm(b - a))


_OURS = dict(
    zip(HUMANOID.body_names, forward_kinematics(HUMANOID.rest_state()).pos_w, strict=True),
)
