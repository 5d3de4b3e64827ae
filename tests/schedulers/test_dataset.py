"""Tests for dataset.py."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tests.samples import swaying_clip
from tests.schedulers.test_stitching import TICK_NS, path_of, play
from unicon.errors import UniconError, UnknownNameError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter
from unicon.schedulers.dataset import DatasetConfig, DatasetScheduler, at_speed, choose
from unicon.schedulers.stitching import StitcherConfig

LABELS = {
    "amble": "walking/forward",
    "stroll": "walking/forward",
    "retreat": "walking/backward",
    "walking": "dance",
    "climb": "climbing",
}
SHORT = DatasetConfig(seed=3, stitcher=StitcherConfig(window=4, transition_s=0.1))


@pytest.fixture(scope="module")
def library(tmp_path_factory) -> ClipLibrary:
    folder = tmp_path_factory.mktemp("library")
    with LibraryWriter(folder) as writer:
        for name, label in LABELS.items():
            marks = ("uneven_ground",) if label == "climbing" else ()
            clip = swaying_clip(20, speed=1.0, name=name)
            writer.add(ClipInfo(name, len(clip), label, name, marks=marks), clip.frames)
        writer.commit()
    return ClipLibrary(folder)


def names(library: ClipLibrary, what: str) -> set[str]:
    return {info.name for info in choose(library.infos, what).infos}


def played(scheduler: DatasetScheduler, ticks: int) -> list[str]:
    """Return the names of the clips in the order in which they play."""
    order = [""]
    for tick in range(ticks):
        scheduler.stitcher.next_frames(tick * TICK_NS)
        if scheduler.stitcher.playing.name != order[-1]:
            order.append(scheduler.stitcher.playing.name)
    return order[1:]


@pytest.mark.parametrize(
    ("what", "expected"),
    [
        ("amble", {"amble"}),
        ("walking", {"walking"}),
        ("walking/", {"amble", "stroll", "retreat"}),
        ("walking/forward", {"amble", "stroll"}),
        ("", {"amble", "stroll", "retreat", "walking"}),
        ("climbing", {"climb"}),
        ("climb", {"climb"}),
    ],
)
def test_a_name_comes_before_a_class_and_marked_clips_play_only_when_asked_for(library, what, expected):
    assert names(library, what) == expected


@pytest.mark.parametrize(("what", "near"), [("strol", "stroll"), ("walking/forwards", "walking/forward/")])
def test_an_unknown_name_is_answered_with_the_nearest(library, what, near):
    with pytest.raises(UnknownNameError, match=f"no clip and no class '{what}'; the nearest are .*{near}"):
        choose(library.infos, what)


def test_the_beginning_of_a_class_name_is_no_class(library):
    with pytest.raises(UnknownNameError):
        choose(library.infos, "walk")


def test_one_clip_plays_once_and_then_it_stands(library):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("amble", 1.0, loop=False)
    assert played(scheduler, 120) == ["amble", ""]
    assert scheduler.stitcher.empty


def test_a_loop_goes_on_from_where_the_clip_ended(library):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("amble", 1.0, loop=True)
    path = path_of(play(scheduler.stitcher, 240))
    assert path[-1, 0] > 2.5
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() < 2.0 / 60


def test_random_clips_are_balanced_over_the_classes(library):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("", 4.0, loop=True)
    counts = Counter(scheduler._next_clip().name for _ in range(400))
    assert set(counts) == {"amble", "stroll", "retreat", "walking"}
    assert abs(counts["walking"] - 200) < 50
    assert abs(counts["retreat"] - 100) < 40


def test_the_same_seed_plays_the_same_clips(library):
    def order(seed: int) -> list[str]:
        scheduler = DatasetScheduler(library, DatasetConfig(seed, SHORT.stitcher), 0)
        scheduler.play("walking/", 1.0, loop=True)
        return [scheduler._next_clip().name for _ in range(20)]

    assert order(1) == order(1)
    assert order(1) != order(2)


def test_what_is_asked_for_comes_at_once_without_a_jump(library):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("amble", 1.0, loop=True)
    before = path_of(play(scheduler.stitcher, 30))
    scheduler.play("retreat", 1.0, loop=True)
    after = path_of(play(scheduler.stitcher, 20, first=30))
    assert scheduler.stitcher.playing.name == "retreat"
    steps = np.linalg.norm(np.diff(np.concatenate([before, after]), axis=0), axis=1)
    assert steps.max() < 2.0 / 60


def test_stopping_goes_over_into_standing(library):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("", 1.0, loop=True)
    play(scheduler.stitcher, 30)
    scheduler.stop()
    last = play(scheduler.stitcher, 60, first=30)[-1]
    assert scheduler.stitcher.empty
    assert not last.frames.root_lin_vel_w.any()


@pytest.mark.parametrize("speed", [0.09, 4.1, -1.0, float("nan")])
def test_a_speed_out_of_range_is_refused_and_what_played_goes_on(library, speed):
    scheduler = DatasetScheduler(library, SHORT, 0)
    scheduler.play("amble", 1.0, loop=True)
    with pytest.raises(UniconError, match="expected 0.1 to 4"):
        scheduler.play("retreat", speed, loop=True)
    assert set(played(scheduler, 60)) == {"amble"}


@pytest.mark.parametrize("speed", [0.1, 0.5, 1.0, 1.7, 4.0])
def test_a_clip_of_another_speed_goes_the_same_way_in_another_time(speed):
    clip = swaying_clip(121, speed=0.6)
    other = at_speed(clip, speed)
    assert len(other) == int(120 / speed) + 1
    assert np.allclose(other.frames.root_lin_vel_w[1:-1, 0], 0.6 * speed)
    way = other.frames.root_pos_w[-1, 0] - other.frames.root_pos_w[0, 0]
    assert np.isclose(way, 0.6 * (len(other) - 1) / 60 * speed)
    assert (other.name, other.label) == (clip.name, clip.label)


def test_even_the_shortest_clip_has_two_frames_at_the_highest_speed():
    assert len(at_speed(swaying_clip(2), 4.0)) == 2
