"""A network for tests that goes along the path it is given, and a card with limits."""

from __future__ import annotations

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.schedulers.pfnn.layout import LAYOUT_ID, PRESENT, SAMPLE_FRAMES, pack_output, unpack_input
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard

CARD = PhaseNetworkCard(
    name="steerable",
    description="goes along the path ahead",
    layout_id=LAYOUT_ID,
    humanoid_id=HUMANOID.id,
    limits={"forward_m_s": 3.0, "backward_m_s": 1.0, "sideways_m_s": 0.8, "turn_rad_s": 1.5},
    gait_speeds_m_s={"walk": (0.5, 1.2, 1.6), "jog": (1.8, 2.2, 2.6)},
)


class Steerable:
    """Moves and turns as the first samples ahead say, its left hip following the phase."""

    def __init__(self) -> None:
        self.asked = 0

    def predict(self, x: np.ndarray, phase: float) -> np.ndarray:
        """Return how to go on along the path of the input."""
        self.asked += 1
        parts = unpack_input(x)
        pos_h, facing_h = parts["path_pos_h"][PRESENT:], parts["path_facing_h"][PRESENT:]
        angle = np.unwrap(np.arctan2(facing_h[:, 1], facing_h[:, 0]))
        per_s = 60.0 / SAMPLE_FRAMES
        joint_pos = np.zeros(35)
        joint_pos[HUMANOID.joint_names.index("left_hip_y")] = 0.3 * np.sin(phase)
        turn = (angle[1] - angle[0]) * per_s
        return pack_output(
            {
                "root_vel_h": (pos_h[1] - pos_h[0]) * per_s,
                "turn_rate": np.array([turn]),
                "phase_rate": np.array([6.0]),
                "contacts": np.zeros(4),
                "path_pos_h": pos_h - pos_h[0],
                "path_facing_h": facing_h,
                "root_height": np.array([0.95]),
                "root_rot6d_h": np.array([2.0, 0, 0, 0.1, 1.0, 0]),
                "joint_pos": joint_pos,
                "joint_vel": np.zeros(35),
            }
        )
