"""Tests for layout.py."""

import numpy as np
import pytest

from unicon.observation import OBSERVATION_SIZE
from unicon.schedulers.pfnn.layout import (
    AHEAD,
    CONTACTS,
    GAITS,
    INPUT_LAYOUT,
    INPUT_SIZE,
    LAYOUT_ID,
    OUTPUT_LAYOUT,
    OUTPUT_SIZE,
    PRESENT,
    SAMPLE_FRAMES,
    SAMPLES,
    PathSamples,
    pack_input,
    pack_output,
    unpack_input,
    unpack_output,
)


def test_the_sizes_are_those_counted_by_hand():
    assert INPUT_SIZE == 12 * 2 + 12 * 2 + 12 * 5 + 197 == 305
    assert OUTPUT_SIZE == 2 + 1 + 1 + 4 + 6 * 2 + 6 * 2 + 1 + 6 + 35 + 35 == 109
    assert (len(GAITS), len(CONTACTS), OBSERVATION_SIZE) == (5, 4, 197)


def test_the_path_reaches_from_a_second_before_to_five_sixths_of_one_after():
    seconds = (np.arange(SAMPLES) - PRESENT) * SAMPLE_FRAMES / 60.0
    assert (seconds[0], seconds[PRESENT], seconds[-1]) == pytest.approx((-1.0, 0.0, 5 / 6))
    assert AHEAD == 6


@pytest.mark.parametrize("batch", [(), (3,), (2, 4)])
def test_an_input_comes_apart_as_it_was_put_together(batch):
    rng = np.random.default_rng(0)
    path = PathSamples(*(rng.standard_normal((*batch, SAMPLES, n)) for n in (2, 2, len(GAITS))))
    pose = rng.standard_normal((*batch, OBSERVATION_SIZE))
    x = pack_input(path, pose)
    assert x.shape == (*batch, INPUT_SIZE)
    parts = unpack_input(x)
    assert list(parts) == [name for name, _ in INPUT_LAYOUT]
    for part, expected in zip(parts.values(), (*path, pose), strict=True):
        assert np.array_equal(part, expected)


@pytest.mark.parametrize("batch", [(), (3,), (2, 4)])
def test_an_output_comes_apart_as_it_was_put_together(batch):
    rng = np.random.default_rng(0)
    parts = {name: rng.standard_normal((*batch, *shape)) for name, shape in OUTPUT_LAYOUT}
    y = pack_output(parts)
    assert y.shape == (*batch, OUTPUT_SIZE)
    back = unpack_output(y)
    assert list(back) == list(parts)
    assert all(np.array_equal(back[name], parts[name]) for name in parts)


def test_the_parts_stand_in_the_order_of_the_layout():
    y = unpack_output(np.arange(OUTPUT_SIZE))
    assert y["root_vel_h"].tolist() == [0, 1]
    assert y["turn_rate"].tolist() == [2]
    assert y["contacts"].tolist() == [4, 5, 6, 7]
    assert y["path_pos_h"][1].tolist() == [10, 11]
    assert y["joint_vel"][-1] == OUTPUT_SIZE - 1
    x = unpack_input(np.arange(INPUT_SIZE))
    assert x["path_facing_h"][0].tolist() == [24, 25]
    assert x["path_gait"][1].tolist() == [53, 54, 55, 56, 57]
    assert x["pose"][0] == 108


def test_a_part_that_is_missing_is_named():
    with pytest.raises(KeyError, match="turn_rate"):
        pack_output({"root_vel_h": np.zeros(2)})


def test_the_layout_has_a_name():
    assert len(LAYOUT_ID) == 16
    assert int(LAYOUT_ID, 16) > 0
