"""Which library an array belongs to: what is written once runs on numpy and torch alike."""

from __future__ import annotations

from typing import Any

import array_api_compat
import array_api_compat.numpy
import numpy as np


def array_namespace(*arrays: Any) -> Any:
    """Return the array API of the arrays' library.

    Numpy arrays, of which a tick handles dozens, are told at once; the general search takes ten times
    as long.
    """
    if type(arrays[0]) is np.ndarray:
        return array_api_compat.numpy
    return array_api_compat.array_namespace(*arrays)
