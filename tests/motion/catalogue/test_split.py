import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.errors import UniconError
from unicon.motion.catalogue.split import SplitSettings, split_clips
from unicon.motion.clip_index import ClipInfo


def clips(label, count, frames=100, takes=None):
    return [
        ClipInfo(f"{label}{k}", frames, label, take=f"{label}{k % (takes or count)}") for k in range(count)
    ]


def side(rows, name, **settings):
    return split_clips(rows, SplitSettings(**settings)).sides[name]


def test_a_class_with_a_single_clip_goes_to_the_test_set():
    assert side([*clips("walking", 20), *clips("zombie", 1)], "zombie0") == "test"


def test_a_class_with_copies_of_a_single_take_goes_to_the_test_set():
    sides = split_clips([*clips("walking", 20), *clips("zombie", 3, takes=1)]).sides
    assert {sides[f"zombie{k}"] for k in range(3)} == {"test"}


def test_a_fifth_of_the_frames_is_test():
    rows = [*clips("walking", 50), *clips("running", 30), *clips("zombie", 1), *clips("hop", 2)]
    sides = split_clips(rows).sides
    # by hand: 8300 frames, 1660 wanted; zombie 1; hop 1 of 2; then 1460 of 8000 missing: 5 of 30 running
    # (547 frames wanted), and 960 of 5000 missing: 10 of 50 walking (9 and a half rounds up)
    counts = {
        label: sum(sides[c.name] == "test" for c in rows if c.label == label)
        for label in ("zombie", "hop", "running", "walking")
    }
    assert counts == {"zombie": 1, "hop": 1, "running": 5, "walking": 10}


def test_single_clips_stop_going_to_the_test_set_when_it_is_full():
    rows = [ClipInfo(name, 100, name) for name in "abcdefghij"]
    sides = split_clips(rows).sides
    assert [name for name in "abcdefghij" if sides[name] == "test"] == ["a", "b"]


def test_every_class_of_two_or_more_takes_is_on_both_sides():
    rows = [row for k, label in enumerate("abcdef") for row in clips(label, 2 + 5 * k)]
    sides = split_clips(rows).sides
    for label in "abcdef":
        assert {sides[row.name] for row in rows if row.label == label} == {"train", "test"}


def test_a_take_of_two_classes_is_on_the_side_of_its_rarer_class():
    rows = [*clips("walking", 20), ClipInfo("cut", 10, "zombie", take="walking3")]
    sides = split_clips(rows).sides
    assert sides["cut"] == sides["walking3"] == "test"


def test_clips_without_a_take_are_takes_of_their_own():
    sides = split_clips([ClipInfo(f"w{k}", 100, "walking") for k in range(10)]).sides
    assert list(sides.values()).count("test") == 2


def test_another_seed_draws_other_takes():
    rows = clips("walking", 40)
    assert split_clips(rows).sides != split_clips(rows, SplitSettings(seed=1)).sides


def test_the_order_within_a_class_is_that_of_the_hash_of_seed_and_take():
    # printf 0:walking3 | sha256sum and so on: walking3 and walking7 come first
    sides = split_clips(clips("walking", 10)).sides
    assert [name for name in sides if sides[name] == "test"] == ["walking3", "walking7"]


@pytest.mark.parametrize("share", [-0.1, 1.0, float("nan")])
def test_a_share_outside_0_to_1_is_refused(share):
    with pytest.raises(UniconError, match="test_share"):
        SplitSettings(share)


def test_no_clips_make_an_empty_split():
    assert split_clips([]).sides == {}


rows_of_any_kind = st.lists(
    st.builds(
        ClipInfo,
        name=st.uuids().map(str),
        frames=st.integers(2, 500),
        label=st.sampled_from(["walking", "walking/turn", "dance/salsa", "hop", ""]),
        take=st.sampled_from(["", "t1", "t2", "t3", "t4", "t5"]),
    ),
    unique_by=lambda info: info.name,
    max_size=30,
)


@given(rows_of_any_kind, st.randoms(use_true_random=False))
def test_the_order_of_the_clips_does_not_matter(rows, rng: random.Random):
    shuffled = rng.sample(rows, len(rows))
    assert split_clips(shuffled) == split_clips(rows)


@given(rows_of_any_kind)
def test_takes_stay_on_one_side_and_every_clip_has_one(rows):
    sides = split_clips(rows).sides
    assert sides.keys() == {info.name for info in rows}
    for take in {info.take for info in rows} - {""}:
        assert len({sides[info.name] for info in rows if info.take == take}) == 1
