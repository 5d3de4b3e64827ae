"""Brings a motion of any skeleton onto the humanoid: fits its poses, puts them on the ground, measures."""

from __future__ import annotations

from typing import NamedTuple

from unicon.motion.clip import Clip
from unicon.motion.grounding.ground import ground
from unicon.motion.grounding.quality import ClipQuality, measure
from unicon.motion.retargeting.pose_fitting import fit_poses
from unicon.motion.source_motion import SourceMotion

VERSION = 2
"""Raised whenever clips come out differently, so that cached ones are made again."""


class Retargeted(NamedTuple):
    """A motion on our humanoid."""

    clip: Clip
    quality: ClipQuality


def retarget(motion: SourceMotion) -> Retargeted:
    """Return a motion, recognised before (skeletons.py), on our humanoid at 60 Hz.

    Raises:
        InputFileError: when the motion is too short.
    """
    fitted = fit_poses(motion)
    grounded = ground(fitted.frames)
    quality = measure(grounded.frames, grounded.contact, fitted.reference_pos, fitted.reference_bodies)
    clip = Clip(
        motion.name, grounded.frames, source=motion.source, licence=motion.licence, label=motion.label
    )
    return Retargeted(clip, quality)
