"""Tests for frame_sampler.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.frame_sampler import FrameSampler
from unicon.motion.store.library import ClipLibrary, as_rows
from unicon.motion.store.library_index import POSE_WIDTH
from unicon.motion.store.library_writer import LibraryWriter

LENGTHS = (5, 2, 30)


@pytest.fixture
def library(tmp_path):
    rng = np.random.default_rng(0)
    with LibraryWriter(tmp_path / "library") as writer:
        for row, count in enumerate(LENGTHS):
            writer.add_rows(ClipInfo(f"clip{row}", count), rng.standard_normal((count, 83)))
        writer.commit()
    return ClipLibrary(tmp_path / "library")


def test_states_are_those_at_the_start_and_its_offsets(library):
    batch = FrameSampler(library, offsets=(0, 1, 4)).gather(np.array([2, 0]), np.array([7, 0]))
    assert batch.states.batch_shape == (2, 3)
    assert batch.states.root_pos_w.dtype == np.float32
    expected = library.array[[[7 + 7, 7 + 8, 7 + 11], [0, 1, 4]]]
    assert np.array_equal(as_rows(batch.states), expected)
    assert not batch.held.any()


def test_past_the_end_the_last_pose_is_held_at_rest(library):
    batch = FrameSampler(library, offsets=(1, 2)).gather(np.array([1]), np.array([0]))
    rows = as_rows(batch.states)[0]
    assert batch.held.tolist() == [[False, True]]
    assert np.array_equal(rows[0], library.array[6])
    assert np.array_equal(rows[1, :POSE_WIDTH], library.array[6, :POSE_WIDTH])
    assert np.all(rows[1, POSE_WIDTH:] == 0.0)


def test_a_start_always_has_a_frame_that_follows(library):
    batch = FrameSampler(library).sample(2000, np.random.default_rng(1))
    lengths = np.array(LENGTHS)[batch.rows]
    assert np.all(batch.frames >= 0)
    assert np.all(batch.frames + 1 < lengths)
    assert not batch.held.any()
    assert set(batch.frames[batch.rows == 0]) == {0, 1, 2, 3}


def test_clips_are_drawn_by_their_probabilities(library):
    sampler = FrameSampler(library, probabilities=np.array([0.2, 0.0, 0.6]))
    rows = sampler.sample(20_000, np.random.default_rng(2)).rows
    shares = np.bincount(rows, minlength=3) / len(rows)
    assert np.allclose(shares, [0.25, 0.0, 0.75], atol=0.015)


def test_without_probabilities_every_frame_is_equally_likely(library):
    rows = FrameSampler(library).sample(20_000, np.random.default_rng(3)).rows
    shares = np.bincount(rows, minlength=3) / len(rows)
    assert np.allclose(shares, np.array([4, 1, 29]) / 34, atol=0.015)


def test_only_the_chosen_clips_are_drawn(library):
    sampler = FrameSampler(library, rows=[2, 1], probabilities=np.array([1.0, 0.0]))
    batch = sampler.sample(100, np.random.default_rng(4))
    assert set(batch.rows) == {2}
    assert np.array_equal(as_rows(batch.states)[:, 0], library.array[7 + batch.frames])


def test_the_same_seed_draws_the_same_frames(library):
    sampler = FrameSampler(library)
    one, two = (sampler.sample(50, np.random.default_rng(5)) for _ in range(2))
    assert np.array_equal(one.rows, two.rows) and np.array_equal(one.frames, two.frames)


@pytest.mark.parametrize(
    "options",
    [
        {"rows": []},
        {"offsets": (-1,)},
        {"probabilities": np.ones(2)},
        {"probabilities": np.zeros(3)},
        {"probabilities": np.array([1.0, -1.0, 1.0])},
    ],
)
def test_what_cannot_be_drawn_from_is_refused(library, options):
    with pytest.raises(ValueError, match="needs"):
        FrameSampler(library, **options)
