import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from unicon.train.learning.normalizer import RunningNormalizer, merge, moments_of


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(1, 40), min_size=1, max_size=5), st.floats(-50, 50), st.integers(0, 2**31))
def test_parts_taken_in_give_numpys_mean_and_deviation_of_the_whole(sizes, place, seed):
    rng = np.random.default_rng(seed)
    parts = [rng.normal(place, [0.1, 1.0, 10.0], (size, 3)).astype(np.float32) for size in sizes]
    normalizer = RunningNormalizer(3)
    normalizer.commit(moments_of(torch.from_numpy(parts[0])))
    for part in parts[1:]:
        normalizer.take_in(torch.from_numpy(part), out=torch.empty(part.shape))
    normalizer.commit(normalizer.pending())
    whole = np.concatenate(parts).astype(np.float64)
    assert normalizer.count == len(whole)
    assert np.allclose(normalizer.running_mean.numpy(), whole.mean(axis=0), rtol=1e-3, atol=1e-3)
    if len(parts[0]) > 1:  # of one sample the deviation is 0, which makes the scale of what follows useless
        assert np.allclose(normalizer.running_variance.numpy(), whole.var(axis=0), rtol=1e-2)


def test_two_sets_merge_as_by_hand():
    both = merge(moments_of(torch.tensor([[1.0], [3.0]])), moments_of(torch.tensor([[8.0]])))
    assert both.count == 3
    assert both.mean.item() == pytest.approx(4.0)
    assert both.variance.item() == pytest.approx((9 + 1 + 16) / 3)


def test_merging_does_not_depend_on_the_order():
    a, b = (moments_of(torch.randn(n, 4, generator=torch.Generator().manual_seed(n))) for n in (5, 90))
    for one, other in zip(merge(a, b), merge(b, a), strict=True):
        assert torch.allclose(one, other, atol=1e-12)


def test_nothing_changes_until_the_commit():
    normalizer = RunningNormalizer(1)
    out = torch.empty(2, 1)
    normalizer.take_in(torch.tensor([[3.0], [9.0]]), out=out)
    assert out.flatten().tolist() == [3.0, 5.0]  # cut off at 5 sigma
    normalizer.commit(normalizer.pending())
    assert normalizer(torch.tensor([[6.0]])).item() == pytest.approx(0.0)
    assert normalizer(torch.tensor([[9.0]])).item() == pytest.approx(1.0, abs=1e-5)


def test_what_was_committed_is_pending_no_more():
    normalizer = RunningNormalizer(1)
    normalizer.take_in(torch.tensor([[3.0], [9.0]]), out=torch.empty(2, 1))
    normalizer.commit(normalizer.pending())
    assert normalizer.pending().count == 0


def test_the_past_is_forgotten_where_its_weight_is_bounded():
    normalizer = RunningNormalizer(1, memory=10)
    for value in (0.0, 1.0):
        for _ in range(30):
            normalizer.commit(moments_of(torch.full((10, 1), value)))
    assert normalizer.mean.item() == pytest.approx(1.0, abs=1e-4)


def test_a_value_that_is_not_finite_shows_in_the_moments():
    normalizer = RunningNormalizer(2)
    normalizer.take_in(torch.tensor([[0.0, float("nan")]]), out=torch.empty(1, 2))
    assert torch.isfinite(normalizer.pending().mean).tolist() == [True, False]
