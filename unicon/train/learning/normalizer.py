"""Running normalisation of the observations: frozen while a batch is collected, merged afterwards.

Means and variances of parts are joined as in Chan, Golub and LeVeque (1979): with d = mean_b - mean_a,

    n = n_a + n_b,   mean = mean_a + d n_b / n,   n var = n_a var_a + n_b var_b + d^2 n_a n_b / n
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from unicon.policy_file import INPUT_CLIP

MIN_VARIANCE = 1e-6


class Moments(NamedTuple):
    """Count, mean and variance (divided by n) of a set of observations, in float64."""

    count: Tensor
    """``()``."""
    mean: Tensor
    """``(O,)``."""
    variance: Tensor
    """``(O,)``."""


def moments_of(batch: Tensor) -> Moments:
    """Return the moments of a batch ``(N, O)``."""
    variance, mean = torch.var_mean(batch.double(), dim=0, correction=0)
    return Moments(torch.tensor(float(len(batch)), dtype=torch.float64, device=batch.device), mean, variance)


def merge(a: Moments, b: Moments) -> Moments:
    """Return the moments of both sets together."""
    count = a.count + b.count
    share = b.count / count.clamp(min=1.0)
    difference = b.mean - a.mean
    mean = a.mean + difference * share
    variance = (
        a.variance * (1.0 - share) + b.variance * share + difference * difference * share * (1.0 - share)
    )
    return Moments(count, mean, variance)


class RunningNormalizer(nn.Module):
    """Brings observations to mean 0 and deviation 1, cut off at 5 sigma.

    ``mean`` and ``std`` stay as they are until ``commit``, so that everything within an iteration is
    normalised alike, and the same as in ``unicon.policy_file.PolicyWeights.evaluate``.
    """

    count: Tensor
    running_mean: Tensor
    running_variance: Tensor
    mean: Tensor
    std: Tensor

    def __init__(self, size: int, memory: float = float("inf")) -> None:
        """Begin with mean 0 and deviation 1.

        Args:
            size: O.
            memory: as how many samples the past counts at most, so that it can be forgotten.
        """
        super().__init__()
        self.memory = memory
        self.register_buffer("count", torch.zeros((), dtype=torch.float64))
        self.register_buffer("running_mean", torch.zeros(size, dtype=torch.float64))
        self.register_buffer("running_variance", torch.ones(size, dtype=torch.float64))
        self.register_buffer("mean", torch.zeros(size))
        self.register_buffer("std", torch.ones(size))
        self._forget_pending()

    @property
    def moments(self) -> Moments:
        """All that was committed."""
        return Moments(self.count, self.running_mean, self.running_variance)

    def forward(self, observation: Tensor) -> Tensor:
        """Return observations ``(..., O)`` normalised and cut off."""
        return ((observation - self.mean) / self.std).clamp(-INPUT_CLIP, INPUT_CLIP)

    def take_in(self, observation: Tensor, out: Tensor) -> None:
        """Write a batch ``(N, O)`` normalised into ``out`` and count it for the next ``commit``.

        The sums are those of the normalised values: they lie near 0, so float32 is exact enough.
        """
        z = (observation - self.mean).div_(self.std)
        self._pending_count += len(z)
        self._pending_sum += z.sum(dim=0)
        self._pending_squares += (z * z).sum(dim=0)
        out.copy_(z.clamp_(-INPUT_CLIP, INPUT_CLIP))

    def pending(self) -> Moments:
        """Return the moments of what was taken in since the last ``commit``."""
        count = torch.tensor(float(self._pending_count), dtype=torch.float64, device=self.mean.device)
        std = self.std.double()
        shift = self._pending_sum / count.clamp(min=1.0)
        spread = (self._pending_squares / count.clamp(min=1.0) - shift * shift).clamp(min=0.0)
        return Moments(count, self.mean.double() + std * shift, std * std * spread)

    def commit(self, moments: Moments) -> None:
        """Merge moments, those pending here or joined over processes, and normalise by them from now on."""
        merged = merge(self.moments, moments)
        self.count.copy_(merged.count.clamp(max=self.memory))
        self.running_mean.copy_(merged.mean)
        self.running_variance.copy_(merged.variance)
        self.mean.copy_(merged.mean)
        self.std.copy_((merged.variance + MIN_VARIANCE).sqrt())
        self._forget_pending()

    def _forget_pending(self) -> None:
        self._pending_count = 0
        self._pending_sum = torch.zeros_like(self.running_mean)
        self._pending_squares = torch.zeros_like(self.running_mean)
