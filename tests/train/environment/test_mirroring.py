"""Tests for mirroring.py."""

from __future__ import annotations

import numpy as np

from tests.samples import swaying
from unicon.humanoid import HUMANOID
from unicon.target_frames import pack
from unicon.train.environment.mirroring import mirror_rows


def random_rows(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((4, 3, 83)).astype(np.float32)


def test_rows_are_mirrored_as_the_humanoid_is():
    frames = swaying(20)
    assert np.allclose(mirror_rows(pack(frames)), pack(HUMANOID.mirror(frames)), atol=1e-6)


def test_mirroring_twice_changes_nothing_and_keeps_float32():
    rows = random_rows(0)
    once = mirror_rows(rows)
    assert once.dtype == np.float32
    assert not np.array_equal(once, rows)
    assert np.array_equal(mirror_rows(once), rows)
