"""Tests for dataset.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.small_library import make_library
from unicon.errors import UniconError, UnknownNameError
from unicon.train.environment.dataset import DatasetConfig, choose_clips


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return make_library(tmp_path_factory.mktemp("library"))


def names(library, **choice):
    return [info.name for info in choose_clips(library, DatasetConfig(**choice)).infos]


def test_training_has_all_that_is_not_for_the_test_and_bears_no_mark(library):
    assert names(library) == ["walk_a", "walk_b", "dance"]


def test_the_test_split_is_apart_from_it(library):
    assert names(library, split="test") == ["walk_test"]
    assert names(library, split="both") == ["walk_a", "walk_b", "dance", "walk_test"]


def test_a_sub_dataset_has_its_classes_only(library):
    assert names(library, name="walk") == ["walk_a", "walk_b"]
    assert names(library, name="SportDance") == ["dance"]


def test_marks_and_short_clips_can_be_let_through(library):
    assert "stairs" in names(library, keep_marks=("uneven_ground",))
    assert "blink" in names(library, min_seconds=0.0)


def test_clips_can_be_named_whatever_else_is_asked_for(library):
    assert names(library, name="walk", clips=("stairs", "walk_test")) == ["stairs", "walk_test"]


def test_lengths_are_those_of_the_chosen_clips(library):
    assert np.array_equal(choose_clips(library).lengths, [90, 75, 60])


def test_an_empty_choice_says_what_was_asked_for(library):
    with pytest.raises(UniconError, match=r"none of its 6 clips is in Animal and in the split train"):
        choose_clips(library, DatasetConfig(name="animal"))


@pytest.mark.parametrize("choice", [{"name": "walks"}, {"clips": ("walk_z",)}])
def test_unknown_names_are_refused(library, choice):
    with pytest.raises(UnknownNameError):
        choose_clips(library, DatasetConfig(**choice))
