import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chisquare

from unicon.errors import UniconError
from unicon.motion.catalogue.balancer import MotionBalancer
from unicon.motion.catalogue.class_tree import class_tree, top_class
from unicon.motion.clip_index import ClipInfo

labels = st.lists(
    st.lists(st.sampled_from("abc"), min_size=1, max_size=4).map("/".join), min_size=1, max_size=30
)


def probabilities(*names):
    return MotionBalancer([ClipInfo(f"clip{row}", 60, name) for row, name in enumerate(names)]).probabilities


def test_a_hand_made_tree_by_hand():
    # three classes at the top; walking has two children, one of them with two clips
    found = probabilities("walking/forward", "walking/forward", "walking/turn", "dance", "animal/bear")
    np.testing.assert_allclose(found, [1 / 12, 1 / 12, 1 / 6, 1 / 3, 1 / 3])


def test_own_clips_of_a_node_with_children_count_as_one_child():
    found = probabilities("walking", "walking", "walking/turn", "walking/forward/weary")
    np.testing.assert_allclose(found, [1 / 6, 1 / 6, 1 / 3, 1 / 3])


def test_a_thousand_walks_weigh_no_more_than_one_cartwheel():
    found = probabilities(*["walking/forward"] * 1000, "acrobatics/cartwheel")
    assert found[:1000].sum() == pytest.approx(0.5)
    assert found[1000] == pytest.approx(0.5)


def test_draws_are_spread_as_the_probabilities_say():
    rows = [
        ClipInfo(f"{row}", 60, label)
        for row, label in enumerate(["a/b", "a/b", "a/c", "d", "d", "e/f/g", "a"])
    ]
    balancer = MotionBalancer(rows)
    draws = balancer.sample(20_000, np.random.default_rng(1))
    counts = np.bincount(draws, minlength=len(rows))
    assert chisquare(counts, balancer.probabilities * len(draws)).pvalue > 0.01
    assert chisquare(counts).pvalue < 1e-6  # the test can tell this from an even spread


def test_the_same_generator_gives_the_same_draws():
    balancer = MotionBalancer([ClipInfo("a", 60, "a"), ClipInfo("b", 60, "b")])
    first, again = (balancer.sample(100, np.random.default_rng(3)) for _ in range(2))
    np.testing.assert_array_equal(first, again)


def test_draws_stay_inside_at_the_ends_of_the_generator():
    class Extreme:
        def random(self, count):
            return np.array([0.0, np.nextafter(1.0, 0.0)])

    balancer = MotionBalancer([ClipInfo(f"{k}", 60, f"c{k % 7}/{k % 3}") for k in range(49)])
    assert balancer.sample(2, Extreme()).tolist() == [0, 48]


def test_probabilities_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        MotionBalancer([ClipInfo("a", 60)]).probabilities[0] = 2.0


def test_nothing_to_draw_from_is_said():
    with pytest.raises(UniconError, match="no clips"):
        MotionBalancer([])


@given(labels)
def test_probabilities_sum_to_one_and_none_is_zero(names):
    found = probabilities(*names)
    assert found.sum() == pytest.approx(1.0)
    assert (found > 0.0).all()


@given(labels)
def test_siblings_are_equally_likely(names):
    found = probabilities(*names)
    for node in class_tree([ClipInfo(str(row), 60, name) for row, name in enumerate(names)]).root.walk():
        shares = [found[list(child.rows())].sum() for child in node.children]
        shares += [found[list(node.own)].sum()] if node.own else []
        np.testing.assert_allclose(shares, shares[0])


@given(labels, st.integers(0, 29))
def test_one_more_clip_in_a_class_leaves_the_other_top_classes_alone(names, which):
    repeated = names[which % len(names)]
    before, after = probabilities(*names), probabilities(*names, repeated)
    tops = np.array([top_class(name) for name in names])
    for top in set(tops) - {top_class(repeated)}:
        np.testing.assert_allclose(after[:-1][tops == top], before[tops == top])
