"""A phase network of random numbers, small unless asked otherwise."""

from __future__ import annotations

import numpy as np

from unicon.schedulers.pfnn.network import PhaseLayer, PhaseNetwork


def make_network(sizes: tuple[int, ...] = (5, 6, 6, 3), phases: int = 4, **changes) -> PhaseNetwork:
    rng = np.random.default_rng(3)

    def draw(*shape: int) -> np.ndarray:
        return (0.3 * rng.standard_normal(shape)).astype(np.float32)

    layers = tuple(
        PhaseLayer(draw(phases, b, a), draw(phases, b)) for a, b in zip(sizes, sizes[1:], strict=False)
    )
    scales = draw(sizes[0]), 1 + draw(sizes[0]) ** 2, draw(sizes[-1]), 1 + draw(sizes[-1]) ** 2
    return PhaseNetwork(layers, *scales, **changes)
