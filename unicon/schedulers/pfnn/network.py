"""The phase-functioned neural network, run with numpy (Holden, Komura, Saito 2017, section 5).

    z = (x - mean_x) / std_x
    y = mean_y + std_y * (W2 elu(W1 elu(W0 z + b0) + b1) + b2),     W, b = theta(phase)

theta is the closed curve of ``phase_function`` through the weights of K control points. Sums of the layers
of its control points take the place of layers of summed weights: it is the same, and nothing is copied.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from unicon.policy_file import ACTIVATIONS
from unicon.schedulers.pfnn.phase_function import Interpolation, control_weights

PRECOMPUTED_PHASES = 50
"""As in the paper."""
_elu = ACTIVATIONS["elu"]


@dataclass(frozen=True)
class PhaseLayer:
    """A layer at K equally spaced phases, float32."""

    weight: np.ndarray
    """``(K, out, in)``."""
    bias: np.ndarray
    """``(K, out)``."""


@dataclass(frozen=True)
class PhaseNetwork:
    """Layers whose weights depend on the phase, and the normalisation of their input and output."""

    layers: tuple[PhaseLayer, ...]
    input_mean: np.ndarray
    """``(I,)``, as the rest in float32."""
    input_std: np.ndarray
    """``(I,)``: what a part of the input is divided by."""
    output_mean: np.ndarray
    """``(O,)``."""
    output_std: np.ndarray
    """``(O,)``."""
    interpolation: Interpolation = "cubic"
    """Between the phases of the layers."""

    @property
    def sizes(self) -> tuple[int, ...]:
        """Size of the input, then of the output of each layer."""
        return (self.layers[0].weight.shape[2], *(layer.weight.shape[1] for layer in self.layers))

    @property
    def phases(self) -> int:
        """At how many phases the weights are known: K."""
        return len(self.layers[0].weight)

    def predict(self, x: np.ndarray, phase: float) -> np.ndarray:
        """Return y ``(O,)`` for x ``(I,)`` at a phase [rad]."""
        amounts = control_weights(np.asarray(phase, np.float64), self.phases, self.interpolation)
        points = np.flatnonzero(amounts)
        amounts = amounts.astype(np.float32)
        h = (np.asarray(x, np.float32) - self.input_mean) / self.input_std
        for index, layer in enumerate(self.layers):
            if index:
                h = _elu(h)
            h = sum(amounts[k] * (layer.weight[k] @ h + layer.bias[k]) for k in points)
        return (h * self.output_std + self.output_mean).astype(np.float64)

    def precompute(
        self, phases: int = PRECOMPUTED_PHASES, interpolation: Interpolation = "linear"
    ) -> PhaseNetwork:
        """Return the same network with its weights worked out at more phases: faster, and larger.

        Args:
            phases: at how many, equally spaced from 0.
            interpolation: between them, "linear", or "nearest" as the paper's fastest.
        """
        at = np.arange(phases) * (2.0 * math.pi / phases)
        amounts = control_weights(at, self.phases, self.interpolation).astype(np.float32)

        def along(points: np.ndarray) -> np.ndarray:
            return np.tensordot(amounts, points, axes=1)

        layers = tuple(PhaseLayer(along(layer.weight), along(layer.bias)) for layer in self.layers)
        return replace(self, layers=layers, interpolation=interpolation)
