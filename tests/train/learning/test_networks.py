import numpy as np
import pytest
import torch

from unicon.train.learning.networks import ACTIVATIONS, ActorCritic, Mlp, NetworkConfig, export_weights
from unicon.train.learning.normalizer import moments_of


def _network(**changes):
    torch.manual_seed(3)
    network = ActorCritic(11, 4, NetworkConfig((16, 8), (8,), actor_gain=1.0, **changes))
    network.normalizer.commit(moments_of(torch.randn(200, 11) * 3.0 + 1.0))
    return network


@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_the_exported_policy_gives_the_same_outputs(activation):
    network = _network(activation=activation)
    for param in network.actor.parameters():
        param.data += 0.1 * torch.randn_like(param)
    weights = export_weights(network)
    seen = torch.randn(50, 11) * 20.0  # often beyond 5 sigma
    with torch.no_grad():
        expected = network.act(seen).numpy()
    outputs = np.stack([weights.evaluate(row, activation) for row in seen.numpy()])
    assert np.abs(outputs - expected).max() < 1e-5
    assert weights.sizes == (11, 16, 8, 4)


def test_the_exported_weights_are_copies():
    network = _network()
    weights = export_weights(network)
    network.actor.layers[0].weight.data.zero_()
    assert np.abs(weights.layers[0][0]).max() > 0


def test_training_begins_with_almost_no_action():
    network = ActorCritic(30, 35, NetworkConfig())
    with torch.no_grad():
        assert network.act(torch.randn(100, 30)).abs().max() < 0.1


def test_the_first_weights_are_orthogonal():
    weight = Mlp((40, 20, 3), "relu", 0.01).layers[0].weight.detach()
    assert torch.allclose(weight @ weight.T, 2.0 * torch.eye(20), atol=1e-5)


def test_hidden_layers_in_bfloat16_stay_near_float32_and_the_last_layer_is_float32():
    network = _network()
    seen = torch.randn(64, 11)
    with torch.no_grad():
        exact, coarse = network.actor(seen), network.actor(seen.bfloat16())
    assert coarse.dtype == torch.float32
    assert not torch.equal(exact, coarse)
    assert (exact - coarse).abs().max() < 0.05 * exact.abs().max()


def test_values_have_one_number_a_row():
    assert _network().value(torch.randn(3, 7, 11)).shape == (3, 7)
