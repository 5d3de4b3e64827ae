"""The state of a random generator as an array, for checkpoints that hold nothing but arrays."""

from __future__ import annotations

import numpy as np

_MASK = (1 << 32) - 1
_WORDS = 4  # of 32 bits in each of the two numbers of 128 bits


def generator_to_array(rng: np.random.Generator) -> np.ndarray:
    """Return the state ``(10,)`` int64 of a generator on PCG64."""
    state = rng.bit_generator.state
    numbers = (state["state"]["state"], state["state"]["inc"])
    words = [number >> (32 * i) & _MASK for number in numbers for i in range(_WORDS)]
    return np.array([*words, state["has_uint32"], state["uinteger"]], np.int64)


def generator_from_array(array: np.ndarray) -> np.random.Generator:
    """Return a generator in the state that ``generator_to_array`` gave.

    Raises:
        ValueError: when the array has another length.
    """
    if array.shape != (2 * _WORDS + 2,):
        raise ValueError(f"the state of a generator has 10 numbers, got {array.shape}")
    words = [int(word) for word in array]
    halves = (words[:_WORDS], words[_WORDS : 2 * _WORDS])
    state, inc = (sum(word << (32 * i) for i, word in enumerate(half)) for half in halves)
    bits = np.random.PCG64()
    bits.state = {
        "bit_generator": "PCG64",
        "state": {"state": state, "inc": inc},
        "has_uint32": words[-2],
        "uinteger": words[-1],
    }
    return np.random.Generator(bits)
