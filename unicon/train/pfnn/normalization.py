"""How input and output of the network are normalised: every number to mean 0, every part by one scale.

A part is all numbers of one kind, e.g. the x of the path's twelve samples or the 35 hinge angles, and its
scale the mean of their deviations (as in the code of Holden et al. 2017). A number that hardly ever changes,
such as the height of the ground, therefore stays small instead of being blown up to deviation 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from unicon.observation import OBSERVATION_LAYOUT
from unicon.schedulers.pfnn.layout import INPUT_LAYOUT, OUTPUT_LAYOUT

_SMALLEST = 1e-3
_BY_COORDINATE = ("path_pos_h", "path_facing_h", "root_vel_h")
_CHUNK = 65536


class Normalization(NamedTuple):
    """z = (v - mean) / std of input and output, float32."""

    input_mean: np.ndarray
    """``(I,)``."""
    input_std: np.ndarray
    """``(I,)``."""
    output_mean: np.ndarray
    """``(O,)``."""
    output_std: np.ndarray
    """``(O,)``."""


def normalization_of(
    inputs: np.ndarray, outputs: np.ndarray, rows: np.ndarray, pose_scale: float
) -> Normalization:
    """Return the normalisation of samples.

    Args:
        inputs: ``(N, I)``.
        outputs: ``(N, O)``.
        rows: which of them count ``(M,)``.
        pose_scale: what the normalised pose of the input is multiplied by.
    """
    input_mean, input_std = _moments(inputs, rows)
    output_mean, output_std = _moments(outputs, rows)
    for numbers in _parts(INPUT_LAYOUT):
        input_std[numbers] = max(_SMALLEST, input_std[numbers].mean())
    for numbers in _parts(OUTPUT_LAYOUT):
        output_std[numbers] = max(_SMALLEST, output_std[numbers].mean())
    input_std[pose_numbers()] /= pose_scale
    return Normalization(*(v.astype(np.float32) for v in (input_mean, input_std, output_mean, output_std)))


def pose_numbers() -> slice:
    """Return where the pose stands in the input: at its end."""
    sizes = {name: int(np.prod(shape)) for name, shape in INPUT_LAYOUT}
    return slice(sum(sizes.values()) - sizes["pose"], None)


def _parts(layout: tuple[tuple[str, tuple[int, ...]], ...]) -> Iterator[np.ndarray]:
    """Yield the indices of the numbers of each kind."""
    start = 0
    for name, shape in layout:
        numbers = start + np.arange(int(np.prod(shape))).reshape(shape)
        start += numbers.size
        if name == "pose":
            sizes = [size for _, size in OBSERVATION_LAYOUT]
            yield from np.split(numbers, np.cumsum(sizes)[:-1])
        elif name in _BY_COORDINATE:
            yield from np.moveaxis(numbers, -1, 0).reshape(shape[-1], -1)
        else:
            yield numbers.ravel()


def _moments(values: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mean and deviation ``(n,)`` in float64, without a copy of all values."""
    shift = values[rows[0]].astype(np.float64)
    total, squares = np.zeros_like(shift), np.zeros_like(shift)
    for start in range(0, len(rows), _CHUNK):
        part = values[rows[start : start + _CHUNK]] - shift
        total += part.sum(axis=0)
        squares += np.square(part).sum(axis=0)
    mean = total / len(rows)
    return mean + shift, np.sqrt(np.maximum(squares / len(rows) - mean * mean, 0.0))
