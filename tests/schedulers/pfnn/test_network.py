"""Tests for network.py."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.schedulers.pfnn.small_network import make_network
from unicon.schedulers.pfnn.network import PhaseLayer, PhaseNetwork

X = np.array([0.3, -1.0, 2.0, 0.0, 0.7])


def test_a_case_by_hand():
    # one number in and out; weights 1, 2, 3, 4 of the first layer, 1 elsewhere; bias 0.5 in the last
    def layer(weights, bias):
        return PhaseLayer(np.array(weights, np.float32).reshape(4, 1, 1), np.full((4, 1), bias, np.float32))

    layers = (layer([1, 2, 3, 4], 0.0), layer([1] * 4, 0.0), layer([1] * 4, 0.5))
    scales = [np.array([value], np.float32) for value in (1.0, 2.0, 10.0, 3.0)]
    network = PhaseNetwork(layers, *scales)
    # x = 5: z = (5 - 1) / 2 = 2; at pi / 2 the weight is 2, h = 4; y = 10 + 3 (4 + 0.5)
    assert network.predict(np.array([5.0]), math.pi / 2) == pytest.approx([23.5])
    # x = -1: z = -1; at 0 h = elu(-1) = exp(-1) - 1, elu of it once more
    h = math.expm1(math.expm1(-1.0))
    assert network.predict(np.array([-1.0]), 0.0) == pytest.approx([10 + 3 * (h + 0.5)])


@pytest.mark.parametrize("phase", [0.0, 0.4, 2.9, 6.1])
def test_the_weights_are_mixed_before_the_layers_act(phase):
    network = make_network()
    mixed = network.precompute(1, "nearest")  # of phase 0 alone
    turned = PhaseNetwork(
        tuple(
            PhaseLayer(np.roll(layer.weight, -1, 0), np.roll(layer.bias, -1, 0)) for layer in network.layers
        ),
        *(network.input_mean, network.input_std, network.output_mean, network.output_std),
    )
    assert network.predict(X, 0.0) == pytest.approx(mixed.predict(X, phase), abs=1e-6)
    assert network.predict(X, phase) == pytest.approx(turned.predict(X, phase - math.pi / 2), abs=1e-5)


@given(st.floats(-10.0, 10.0))
def test_precomputed_weights_say_nearly_the_same(phase):
    network = make_network()
    exact = network.predict(X, phase)
    assert network.precompute(400).predict(X, phase) == pytest.approx(exact, abs=2e-3)
    assert network.precompute(50).predict(X, phase) == pytest.approx(exact, abs=5e-2)
    assert network.precompute(400, "nearest").predict(X, phase) == pytest.approx(exact, abs=5e-2)


@given(st.integers(0, 49), st.sampled_from(("linear", "nearest")))
def test_precomputed_weights_are_exact_where_they_were_computed(index, kind):
    network = make_network()
    phase = 2 * math.pi * index / 50
    assert network.precompute(50, kind).predict(X, phase) == pytest.approx(
        network.predict(X, phase), abs=1e-5
    )


def test_sizes_and_phases_are_known():
    network = make_network((5, 6, 7, 3))
    assert (network.sizes, network.phases) == ((5, 6, 7, 3), 4)
    assert network.precompute(50).phases == 50
