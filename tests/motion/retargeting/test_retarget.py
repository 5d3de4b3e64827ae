"""Tests for retarget.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.motion.figures import REST_POSES, figure, moving
from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.motion.retargeting.retarget import retarget
from unicon.motion.retargeting.skeletons import recognise


@pytest.fixture(scope="module")
def result():
    motion = recognise(figure(moving(120), REST_POSES["arms out"]))
    return retarget(replace(motion, source="here", licence="free", label="walking"))


def test_the_clip_says_where_it_is_from(result):
    clip = result.clip
    assert (clip.name, clip.source, clip.licence, clip.label) == ("figure", "here", "free", "walking")
    assert len(clip) == 120


def test_the_figures_fit_a_source_of_our_own_proportions(result):
    assert result.quality.mean_error_mm < 15
    assert result.quality.penetration_p99_mm < 20


def test_angles_are_within_the_limits(result):
    angles = result.clip.frames.joint_pos
    assert np.all(angles >= HUMANOID.joint_lower - 1e-12)
    assert np.all(angles <= HUMANOID.joint_upper + 1e-12)


def test_a_motion_of_no_length_is_refused():
    with pytest.raises(InputFileError, match="too short"):
        retarget(recognise(figure(moving(2, 200.0), rate_hz=200.0)))
