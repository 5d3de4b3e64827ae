import numpy as np
import pytest
import torch

from unicon.train.pfnn.normalization import Normalization
from unicon.train.pfnn.torch_network import TorchPhaseLayer, TorchPhaseNetwork


@pytest.fixture
def network():
    rng = np.random.default_rng(0)
    scales = [rng.random(size).astype(np.float32) + 0.5 for size in (7, 7, 3, 3)]
    network = TorchPhaseNetwork(6, Normalization(*scales), torch.Generator().manual_seed(0))
    for layer in network.layers:
        layer.bias.data.normal_(generator=torch.Generator().manual_seed(1))
    return network


def test_what_is_exported_says_the_same(network):
    rng = np.random.default_rng(2)
    x, phases = rng.standard_normal((20, 7)), rng.uniform(-5, 10, 20)
    exported = network.export()
    with torch.no_grad():
        z = network.normalize_input(torch.from_numpy(x).float())
        answered = network(z, torch.from_numpy(phases).float()).numpy()
    y = answered * network.output_std.numpy() + network.output_mean.numpy()
    for index in range(20):
        assert exported.predict(x[index], phases[index]) == pytest.approx(y[index], abs=1e-4)
    assert exported.sizes == (7, 6, 6, 3)


def test_a_copy_is_exported(network):
    exported = network.export()
    before = exported.layers[0].weight.copy()
    network.layers[0].weight.data.zero_()
    network.output_mean.zero_()
    assert np.array_equal(exported.layers[0].weight, before)
    assert exported.output_mean.all()


def test_a_layer_by_hand():
    layer = TorchPhaseLayer(1, 1, torch.Generator())
    layer.weight.data[:, 0, 0] = torch.tensor([1.0, 2.0, 3.0, 4.0])
    layer.bias.data[:, 0] = torch.tensor([10.0, 20.0, 30.0, 40.0])
    amounts = torch.tensor([[0.0, 0.5, 0.5, 0.0], [1.0, 0.0, 0.0, 0.0]])
    h = torch.tensor([[2.0], [5.0]])
    # (2 + 3) / 2 * 2 + 25 and 1 * 5 + 10
    assert layer(h, amounts).flatten().tolist() == [30.0, 15.0]


def test_weights_are_drawn_within_their_bound():
    layer = TorchPhaseLayer(50, 25, torch.Generator().manual_seed(0))
    bound = (6 / 75) ** 0.5
    assert layer.weight.abs().max() < bound
    assert layer.weight.detach().std() == pytest.approx(bound / 3**0.5, rel=0.05)
