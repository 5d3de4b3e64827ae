"""Tests for generator_state.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon.train.environment.generator_state import generator_from_array, generator_to_array


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**63), draws=st.integers(0, 50), halves=st.booleans())
def test_a_generator_goes_on_as_the_one_it_was_saved_from(seed, draws, halves):
    rng = np.random.default_rng(seed)
    rng.random(draws)
    if halves:  # leaves half of a 64-bit number behind
        rng.integers(0, 100, size=1, dtype=np.uint32)
    array = generator_to_array(rng)
    assert array.dtype == np.int64 and array.shape == (10,)
    again = generator_from_array(array)
    for draw in (lambda g: g.integers(0, 100, 3, dtype=np.uint32), lambda g: g.random(5)):
        assert np.array_equal(draw(rng), draw(again))


def test_an_array_of_another_length_is_refused():
    with pytest.raises(ValueError, match="10 numbers"):
        generator_from_array(np.zeros(3, np.int64))
