"""Our retargeting in closed form beside mink's inverse kinematics: same model, frames and error measure.

Processor time on one thread. Ours takes in recognising the skeleton, resampling and scaling; mink is given
the scaled source for free. Errors are those of the poses, before anything is put on the ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from mink_retargeting import MinkConfig, MinkResult, MinkRetargeter, body_targets
from timing import median_core_seconds

from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.grounding.ground import ground
from unicon.motion.grounding.quality import body_errors
from unicon.motion.retargeting.pose_fitting import FittedPoses, fit_poses
from unicon.motion.retargeting.scaled_source import scale_source
from unicon.motion.retargeting.skeletons import recognise
from unicon.motion.source_motion import SourceMotion
from unicon.state import CharacterState


@dataclass
class Tally:
    """What one retargeter did with all motions."""

    seconds: float = 0.0
    errors_m: list[np.ndarray] = field(default_factory=list)
    worst_hinge_vel: float = 0.0

    def add(self, seconds: float, frames: CharacterState, reference: FittedPoses) -> None:
        """Count one motion in."""
        self.seconds += seconds
        bodies = forward_kinematics(frames)
        self.errors_m.append(body_errors(bodies, reference.reference_pos, reference.reference_bodies).ravel())
        self.worst_hinge_vel = max(self.worst_hinge_vel, float(np.abs(frames.joint_vel).max()))

    def figures(self, frames: int) -> dict[str, float]:
        """Return speed, errors and the fastest hinge."""
        errors_mm = 1000 * np.concatenate(self.errors_m)
        return {
            "frames_per_s": frames / self.seconds,
            "mean_error_mm": float(errors_mm.mean()),
            "p99_error_mm": float(np.percentile(errors_mm, 99)),
            "worst_error_mm": float(errors_mm.max()),
            "worst_hinge_velocity_rad_per_s": self.worst_hinge_vel,
        }


def measure_retargeting(
    motions: Sequence[SourceMotion], turns: int, config: MinkConfig
) -> dict[str, float | dict[str, float]]:
    """Return the figures of both over motions as their files have them."""
    ours, theirs, mink = Tally(), Tally(), MinkRetargeter(config)
    frames, ground_s, steps = 0, 0.0, 0.0
    for motion in motions:
        fitted = fit_poses(recognise(motion))
        targets = body_targets(scale_source(recognise(motion)))
        results: list[MinkResult] = []
        seconds = median_core_seconds(
            {
                "ours": lambda motion=motion: fit_poses(recognise(motion)),
                "ground": lambda fitted=fitted: ground(fitted.frames),
                "mink": lambda targets=targets, results=results: results.append(mink.retarget(targets)),
            },
            turns,
        )
        count = len(fitted.frames.root_pos_w)
        frames, ground_s = frames + count, ground_s + seconds["ground"]
        steps += results[0].steps_per_frame * count
        ours.add(seconds["ours"], fitted.frames, fitted)
        theirs.add(seconds["mink"], results[0].frames, fitted)
    with_ground = {"with_ground_frames_per_s": frames / (ours.seconds + ground_s)}
    return {
        "motions": len(motions),
        "frames": frames,
        "ours": ours.figures(frames) | with_ground,
        "mink": theirs.figures(frames) | {"steps_per_frame": steps / frames},
        "times_mink": theirs.seconds / ours.seconds,
        "times_mink_with_ground": theirs.seconds / (ours.seconds + ground_s),
    }
