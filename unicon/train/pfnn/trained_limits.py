"""How fast the samples go: what a network that learned from them may be asked for."""

from __future__ import annotations

import numpy as np

from unicon.schedulers.pfnn.layout import AHEAD, GAITS, PRESENT, SAMPLE_FRAMES, unpack_input, unpack_output

_STEP_S = SAMPLE_FRAMES / 60.0
_SLOWEST_M_S, _SLOWEST_RAD_S = 0.15, 0.2
_FEWEST = 300
"""Samples that make a direction trained at all: 5 s."""


def limits_of(outputs: np.ndarray) -> dict[str, float]:
    """Return how fast samples ``(N, O)`` go forward, backward, sideways [m/s] and turn [rad/s].

    Of all samples that go in a direction, the 95th percentile; 0 where there are hardly any. The speed is
    that along the path in the next 1/6 s, the turn that of the facing in the next 5/6 s.
    """
    parts = unpack_output(outputs)
    forward, left = _velocity_h(parts["path_pos_h"]).T
    facing = parts["path_facing_h"]
    angles = np.arctan2(facing[..., 1], facing[..., 0])
    turn = np.abs(np.unwrap(angles, axis=-1)[:, -1] - angles[:, 0]) / ((AHEAD - 1) * _STEP_S)
    return {
        "forward_m_s": _fast(forward, _SLOWEST_M_S),
        "backward_m_s": _fast(-forward, _SLOWEST_M_S),
        "sideways_m_s": _fast(np.abs(left), _SLOWEST_M_S),
        "turn_rad_s": _fast(turn, _SLOWEST_RAD_S),
    }


def gait_speeds_of(inputs: np.ndarray, outputs: np.ndarray) -> dict[str, tuple[float, float, float]]:
    """Return the 10th, 50th and 90th percentile of the speed [m/s] of each gait that samples show."""
    gaits = unpack_input(inputs)["path_gait"][:, PRESENT].argmax(axis=-1)
    speeds = np.linalg.norm(_velocity_h(unpack_output(outputs)["path_pos_h"]), axis=-1)
    shown = {}
    for index, gait in enumerate(GAITS):
        those = speeds[gaits == index]
        if len(those):
            slow, usual, fast = np.percentile(those, (10, 50, 90)).round(3).tolist()
            shown[gait] = (slow, usual, fast)
    return shown


def _velocity_h(path_pos_h: np.ndarray) -> np.ndarray:
    """Return the velocity ``(N, 2)`` along the path ahead ``(N, 6, 2)``, between its first two samples."""
    return (path_pos_h[:, 1] - path_pos_h[:, 0]) / _STEP_S


def _fast(values: np.ndarray, slowest: float) -> float:
    those = values[values > slowest]
    return round(float(np.percentile(those, 95)), 3) if len(those) >= _FEWEST else 0.0
