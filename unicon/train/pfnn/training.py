"""One step of the training of a phase-functioned network, and its error on the takes it has never seen.

    L = sum_p w_p mean |z_y - net(drop(z_x + noise), phase)|^2_p / sum_p w_p + l1 sum_layers mean |W|

over the parts p of the output, z normalised. Dropout acts on the input of every layer (section 5.4 of the
paper), less on the path than on the rest; the noise on the pose alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import torch
from torch import Tensor

from unicon.errors import UniconError
from unicon.schedulers.pfnn.layout import OUTPUT_LAYOUT, unpack_output
from unicon.train.pfnn.normalization import normalization_of, pose_numbers
from unicon.train.pfnn.torch_network import TorchPhaseNetwork
from unicon.train.pfnn.training_config import LossWeights, NetworkTrainingConfig

if TYPE_CHECKING:
    from unicon.train.pfnn.training_data import TrainingData

_JUDGE_BATCH = 2048


class NetworkError(NamedTuple):
    """How wrong a network is on some samples."""

    loss: float
    """The weighted mean square of the normalised error; 1 is that of answering the mean."""
    parts: dict[str, float]
    """Root mean square error of each part of the output, in its own unit."""
    shares: dict[str, float]
    """Mean square of the normalised error of each part."""


class NetworkTrainer:
    """A network, its optimiser and the samples it learns from."""

    def __init__(self, data: TrainingData, config: NetworkTrainingConfig) -> None:
        """Begin with new weights.

        Raises:
            UniconError: when there is nothing to learn from, or a number is not finite.
        """
        rows = np.flatnonzero(~data.held_out)
        if not len(rows):
            raise UniconError("there are no samples to train on; the library holds no fitting locomotion")
        for name in ("inputs", "outputs", "phases"):
            if not np.isfinite(getattr(data, name)).all():
                raise UniconError(f"the {name} of the training data are not all finite; look at its motions")
        self.config = config
        self.generator = torch.Generator().manual_seed(config.seed)
        self._rows = torch.from_numpy(rows)
        self._held_out = torch.from_numpy(np.flatnonzero(data.held_out))
        self._inputs, self._outputs = torch.from_numpy(data.inputs), torch.from_numpy(data.outputs)
        self._phases = torch.from_numpy(data.phases)
        normalization = normalization_of(data.inputs, data.outputs, rows, config.pose_scale)
        self.network = TorchPhaseNetwork(config.hidden, normalization, self.generator)
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=config.learning_rate, fused=True)
        self.steps = 0
        self._weights = torch.from_numpy(_weights_of_numbers(config.loss))

    @property
    def samples(self) -> tuple[int, int]:
        """How many samples it learns from, and how many are held out."""
        return len(self._rows), len(self._held_out)

    def learning_rate(self, progress: float) -> float:
        """Return Adam's rate when a share of the training is done: half a cosine."""
        first, last = self.config.learning_rate, self.config.learning_rate_end
        return last + 0.5 * (first - last) * (1.0 + math.cos(math.pi * progress))

    def step(self, progress: float) -> Tensor:
        """Learn from one minibatch.

        Args:
            progress: share of the training that is done.

        Returns:
            The weighted mean square of the normalised error ``()``, with dropout and noise.
        """
        for group in self.optimizer.param_groups:
            group["lr"] = self.learning_rate(progress)
        drawn = torch.randint(len(self._rows), (self.config.minibatch,), generator=self.generator)
        rows = self._rows[drawn]
        z = self._disturb(self.network.normalize_input(self._inputs[rows]))
        wanted = self.network.normalize_output(self._outputs[rows])
        error = self.network(z, self._phases[rows], self._drop_hidden) - wanted
        loss = (error.square().mean(dim=0) * self._weights).sum()
        sparsity = sum(layer.weight.abs().mean() for layer in self.network.layers)
        self.optimizer.zero_grad(set_to_none=True)
        (loss + self.config.l1 * sparsity).backward()
        self.optimizer.step()
        self.steps += 1
        return loss.detach()

    def judge(self) -> NetworkError:
        """Return the error on the held-out takes; on all, where none is held out."""
        return self._judge(self._held_out if len(self._held_out) else self._rows)

    def judge_learned(self) -> NetworkError:
        """Return the error on the takes that it learns from, without dropout and noise."""
        return self._judge(self._rows)

    @torch.no_grad()
    def _judge(self, rows: Tensor) -> NetworkError:
        count = min(len(rows), self.config.judge_samples)
        rows = rows[torch.linspace(0, len(rows) - 1, count, dtype=torch.float64).round().long()]
        squares = torch.zeros_like(self.network.output_mean)
        for some in rows.split(_JUDGE_BATCH):
            z = self.network.normalize_input(self._inputs[some])
            wanted = self.network.normalize_output(self._outputs[some])
            squares += (self.network(z, self._phases[some]) - wanted).square().sum(dim=0)
        squares /= count
        in_units = squares * self.network.output_std.square()
        return NetworkError(
            loss=float((squares * self._weights).sum()),
            parts={k: math.sqrt(v.mean()) for k, v in unpack_output(in_units.numpy()).items()},
            shares={k: float(v.mean()) for k, v in unpack_output(squares.numpy()).items()},
        )

    def _disturb(self, z: Tensor) -> Tensor:
        """Return normalised inputs ``(N, I)`` with noise on the pose and numbers left out."""
        start = pose_numbers().start
        path, pose = z[:, :start], z[:, start:]
        noise = torch.randn(pose.shape, generator=self.generator)
        pose = pose + self.config.pose_noise * self.config.pose_scale * noise
        return torch.cat([self._drop(path, self.config.path_dropout), self._drop_hidden(pose)], dim=1)

    def _drop_hidden(self, h: Tensor) -> Tensor:
        return self._drop(h, self.config.dropout)

    def _drop(self, h: Tensor, share: float) -> Tensor:
        """Return numbers with a share of them left out and the rest raised, so that the mean stays."""
        if not share:
            return h
        return h * (torch.rand(h.shape, generator=self.generator) < 1.0 - share) / (1.0 - share)


def _weights_of_numbers(weights: LossWeights) -> np.ndarray:
    """Return the weight of each number of the output ``(O,)``; they sum to 1."""
    parts = [np.full(int(np.prod(shape)), getattr(weights, name)) for name, shape in OUTPUT_LAYOUT]
    flat = np.concatenate([part / part.size for part in parts])
    if flat.min() < 0 or flat.sum() <= 0:
        raise UniconError("training.loss: expected weights of 0 or more, and one above 0")
    return (flat / flat.sum()).astype(np.float32)
