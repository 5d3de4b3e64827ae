"""Tests for episodes.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.small_library import make_dataset, make_library
from unicon.errors import UniconError
from unicon.motion.catalogue.balancer import MotionBalancer
from unicon.train.environment.dataset import DatasetConfig, choose_clips
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.episodes import EpisodeSampler

DRAWS = 40_000


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    return make_dataset(tmp_path_factory.mktemp("library"))


def draw(sampler: EpisodeSampler, seed: int = 0):
    return sampler.draw(DRAWS, np.random.default_rng(seed))


def test_clips_are_drawn_as_the_motion_balancer_says(dataset):
    starts = draw(EpisodeSampler(dataset, EnvironmentConfig()))
    shares = np.bincount(starts.clips, minlength=3) / DRAWS
    assert np.allclose(shares, [0.25, 0.25, 0.5], atol=0.015)  # two walks share what one dance has
    assert np.allclose(shares, MotionBalancer(dataset.infos).probabilities, atol=0.015)


def test_without_the_balancer_every_frame_is_as_likely(dataset):
    starts = draw(EpisodeSampler(dataset, EnvironmentConfig(balancer=False, control_hz=30)))
    counts = np.concatenate([np.bincount(starts.frames[starts.clips == clip]) for clip in range(3)])
    # frames at which a step of two frames can begin
    assert len(counts) == 88 + 73 + 58
    assert np.allclose(counts, DRAWS / 219, atol=6 * np.sqrt(DRAWS / 219))


def test_frames_of_a_clip_are_equally_likely_and_leave_room_for_a_step(dataset):
    for control_hz, last in ((30, 57), (60, 58)):
        starts = draw(EpisodeSampler(dataset, EnvironmentConfig(control_hz=control_hz)))
        counts = np.bincount(starts.frames[starts.clips == 2])
        assert len(counts) == last + 1
        assert np.allclose(counts, counts.mean(), atol=6 * np.sqrt(counts.mean()))


def test_mirrored_episodes_have_their_share(dataset):
    starts = draw(EpisodeSampler(dataset, EnvironmentConfig(mirror_share=0.3)))
    assert starts.mirrored.mean() == pytest.approx(0.3, abs=0.015)
    assert not draw(EpisodeSampler(dataset, EnvironmentConfig(mirror_share=0.0))).mirrored.any()


def test_starts_before_failures_become_likelier_up_to_the_cap(dataset):
    sampler = EpisodeSampler(dataset, EnvironmentConfig(failure_cap=4.0, control_hz=60))
    before = sampler.probabilities.copy()
    frames = np.array([10, 40, 70] * 20)  # the three sections of the first clip; the second is failed at
    for _ in range(64):
        sampler.add(np.zeros(60, np.int64), frames, frames == 40)
    change = sampler.probabilities / before
    assert change[1] / change[2] == pytest.approx(4.0, rel=0.1)
    # 0.7 of the way to the cap
    assert change[0] / change[2] == pytest.approx(1 + 3 * 0.7, rel=0.1)
    assert sampler.probabilities.sum() == pytest.approx(1.0)


def test_a_failure_at_the_last_frame_counts_for_the_last_section(dataset):
    sampler = EpisodeSampler(dataset, EnvironmentConfig(control_hz=60))
    sampler.add(np.array([2]), np.array([59]), np.array([True]))
    assert (
        sampler.failures.failures.sum() == sampler.failures.failures[sampler.failures.section(2, 58)] == 1.0
    )


def test_a_restored_sampler_goes_on_to_the_bit(dataset):
    def go_on(sampler: EpisodeSampler) -> np.ndarray:
        rng, drawn = np.random.default_rng(1), []
        for _ in range(40):
            starts = sampler.draw(20, rng)
            sampler.add(starts.clips, starts.frames, starts.frames > 40)
            drawn.append(np.stack(starts))
        return np.array(drawn)

    one, two = (EpisodeSampler(dataset, EnvironmentConfig()) for _ in range(2))
    go_on(one)
    two.restore(one.state())
    assert np.array_equal(go_on(one), go_on(two))


def test_a_clip_that_is_too_short_for_a_step_is_named(tmp_path):
    library = make_library(tmp_path)
    dataset = choose_clips(library, DatasetConfig(clips=("blink",)))
    EpisodeSampler(dataset, EnvironmentConfig(control_hz=60))
    short = dataset._replace(library=_Shortened(library))
    with pytest.raises(UniconError, match="'blink' is too short"):
        EpisodeSampler(short, EnvironmentConfig(control_hz=30))


class _Shortened:
    """A library whose clips have two frames."""

    def __init__(self, library):
        self.infos = library.infos
        self.lengths = np.full(len(library), 2)
