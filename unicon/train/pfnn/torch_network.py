"""The phase-functioned network in torch, for training; ``unicon.schedulers.pfnn.network`` runs the result.

A layer is linear in its weights, so a batch of different phases needs no weights of its own for each sample:

    W(p) h + b(p) = sum_k a_k(p) (W_k h + b_k) = [a_0 h, a_1 h, a_2 h, a_3 h] [W_0; W_1; W_2; W_3] + ...

which is one product of matrices.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import torch
from torch import Tensor, nn
from torch.nn import functional

from unicon.schedulers.pfnn.network import PhaseLayer, PhaseNetwork
from unicon.schedulers.pfnn.phase_function import CONTROL_POINTS, control_weights
from unicon.train.pfnn.normalization import Normalization


class TorchPhaseLayer(nn.Module):
    """A linear layer at each control point of the phase function."""

    def __init__(self, inputs: int, outputs: int, generator: torch.Generator) -> None:
        """Begin with weights drawn evenly from +-sqrt(6 / (in + out)) (Glorot and Bengio 2010)."""
        super().__init__()
        bound = math.sqrt(6.0 / (inputs + outputs))
        drawn = torch.rand(CONTROL_POINTS, inputs, outputs, generator=generator)
        self.weight = nn.Parameter((2.0 * drawn - 1.0) * bound)
        self.bias = nn.Parameter(torch.zeros(CONTROL_POINTS, outputs))

    def forward(self, h: Tensor, amounts: Tensor) -> Tensor:
        """Return ``(N, out)`` for h ``(N, in)`` and the share of each control point ``(N, 4)``."""
        mixed = (amounts[:, :, None] * h[:, None, :]).flatten(1)
        return torch.addmm(amounts @ self.bias, mixed, self.weight.flatten(0, 1))


class TorchPhaseNetwork(nn.Module):
    """Three layers whose weights depend on the phase; input and output normalised."""

    layers: Sequence[TorchPhaseLayer]
    input_mean: Tensor
    input_std: Tensor
    output_mean: Tensor
    output_std: Tensor

    def __init__(self, hidden: int, normalization: Normalization, generator: torch.Generator) -> None:
        super().__init__()
        for name, values in normalization._asdict().items():
            self.register_buffer(name, torch.from_numpy(values))
        sizes = (len(self.input_mean), hidden, hidden, len(self.output_mean))
        layers = [TorchPhaseLayer(a, b, generator) for a, b in zip(sizes, sizes[1:], strict=False)]
        self.layers = nn.ModuleList(layers)  # type: ignore[assignment]

    def forward(self, z: Tensor, phase: Tensor, drop: Callable[[Tensor], Tensor] | None = None) -> Tensor:
        """Return the normalised output ``(N, O)``.

        Args:
            z: normalised input ``(N, I)``.
            phase: ``(N,)`` [rad].
            drop: what is done to what the hidden layers say, e.g. dropout.
        """
        amounts = control_weights(phase)
        h = z
        for index, layer in enumerate(self.layers):
            if index:
                h = functional.elu(h)
                h = drop(h) if drop else h
            h = layer(h, amounts)
        return h

    def normalize_input(self, x: Tensor) -> Tensor:
        """Return z of inputs ``(N, I)``."""
        return (x - self.input_mean) / self.input_std

    def normalize_output(self, y: Tensor) -> Tensor:
        """Return outputs ``(N, O)`` as the network gives them."""
        return (y - self.output_mean) / self.output_std

    @torch.no_grad()
    def export(self) -> PhaseNetwork:
        """Return a copy of what it has learned, for numpy."""
        layers = tuple(
            PhaseLayer(
                layer.weight.transpose(1, 2).contiguous().numpy().copy(), layer.bias.detach().numpy().copy()
            )
            for layer in self.layers
        )
        return PhaseNetwork(
            layers,
            input_mean=self.input_mean.numpy().copy(),
            input_std=self.input_std.numpy().copy(),
            output_mean=self.output_mean.numpy().copy(),
            output_std=self.output_std.numpy().copy(),
        )
