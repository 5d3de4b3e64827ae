"""Reads the weights that the authors of the paper published (Holden, Komura, Saito 2017), for who has them.

A folder with the files ``W<i>_<phase>.bin`` and ``b<i>_<phase>.bin`` of three layers at 50 phases, and
``Xmean.bin``, ``Xstd.bin``, ``Ymean.bin``, ``Ystd.bin``: float32, little-endian, a matrix row by row as
``(out, in)``. They are for a body of 31 joints and another layout: a network made of them runs, but what it
says means nothing to our humanoid.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from unicon.errors import InputFileError
from unicon.schedulers.pfnn.network import PRECOMPUTED_PHASES, PhaseLayer, PhaseNetwork
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard

ORIGINAL_LAYOUT = "holden-2017-31-joints"
"""Names what its input and output mean: that of the paper's section 4."""
ORIGINAL_SIZES = (342, 512, 512, 311)


def read_original(folder: Path) -> PhaseNetwork:
    """Return the network of a folder.

    Raises:
        InputFileError: when a file is missing, or has another length, or a number that is not finite.
    """
    if not folder.is_dir():
        raise InputFileError(f"{folder}: there is no such folder; expected one with W0_000.bin to b2_049.bin")
    pairs = list(zip(ORIGINAL_SIZES, ORIGINAL_SIZES[1:], strict=False))
    layers = tuple(
        PhaseLayer(
            _read_phases(folder, f"W{index}", (outputs, inputs)),
            _read_phases(folder, f"b{index}", (outputs,)),
        )
        for index, (inputs, outputs) in enumerate(pairs)
    )
    size_x, size_y = ORIGINAL_SIZES[0], ORIGINAL_SIZES[-1]
    mean_x, std_x = (_read(folder / f"X{name}.bin", (size_x,)) for name in ("mean", "std"))
    mean_y, std_y = (_read(folder / f"Y{name}.bin", (size_y,)) for name in ("mean", "std"))
    for file, std in (("Xstd.bin", std_x), ("Ystd.bin", std_y)):
        if (std <= 0).any():
            raise InputFileError(f"{folder / file}: holds {std.min():g}, expected deviations above 0")
    return PhaseNetwork(layers, mean_x, std_x, mean_y, std_y, "linear")


def original_card(name: str) -> PhaseNetworkCard:
    """Return the card of a converted network."""
    return PhaseNetworkCard(
        name=name,
        description="Converted from the weights of Holden, Komura and Saito (2017); not for our humanoid.",
        layout_id=ORIGINAL_LAYOUT,
        training_data=("see the authors' release for its data and its licence",),
    )


def _read_phases(folder: Path, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """Return a layer's numbers ``(50, *shape)``."""
    files = [folder / f"{name}_{phase:03d}.bin" for phase in range(PRECOMPUTED_PHASES)]
    return np.stack([_read(file, shape) for file in files])


def _read(file: Path, shape: tuple[int, ...]) -> np.ndarray:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InputFileError(
            f"{file}: cannot be read ({error.strerror}); copy the whole folder again"
        ) from error
    expected = 4 * int(np.prod(shape))
    if len(content) != expected:
        wanted = " x ".join(map(str, shape))
        raise InputFileError(
            f"{file}: has {len(content)} bytes, expected {expected} ({wanted} float32); copy it again"
        )
    numbers = np.frombuffer(content, "<f4").reshape(shape)
    if not np.isfinite(numbers).all():
        raise InputFileError(f"{file}: holds a number that is not finite; copy it again")
    return numbers
