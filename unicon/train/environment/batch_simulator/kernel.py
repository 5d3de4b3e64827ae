"""The compiled kernel as Python functions on float32 arrays, without copies.

ctypes lets go of the interpreter's lock during each call.
"""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np

from unicon.train.environment.batch_simulator.build import FLAGS, build_kernel

_FLOATS = np.ctypeslib.ndpointer(np.float32, flags="C_CONTIGUOUS")
_BOOLS = np.ctypeslib.ndpointer(np.bool_, flags="C_CONTIGUOUS")


class StepOptions(ctypes.Structure):
    """What a step is told: the fields of options.hpp."""

    _fields_ = (
        ("substeps", ctypes.c_int32),
        ("solves", ctypes.c_int32),
        ("servo", ctypes.c_int32),
        ("timestep", ctypes.c_float),
        ("gravity", ctypes.c_float),
        ("damping_scale", ctypes.c_float),
        ("max_speed", ctypes.c_float),
    )


@cache
def load_kernel(flags: tuple[str, ...] = FLAGS) -> ctypes.CDLL:
    """Return the kernel, compiled with ``flags`` if need be, with the types of its functions.

    Raises:
        NoCompilerError: when it cannot be compiled.
    """
    library = ctypes.CDLL(str(build_kernel(flags)))
    count = ctypes.c_int
    signatures = {
        "unicon_lanes": [],
        "unicon_step": [count, count, ctypes.POINTER(StepOptions), _FLOATS, _FLOATS, _BOOLS],
        "unicon_observe": [count, count, count, _FLOATS, _FLOATS, _FLOATS],
        "unicon_errors": [count, count, _FLOATS, _FLOATS, _FLOATS],
    }
    for name, types in signatures.items():
        function = getattr(library, name)
        function.argtypes = types
        function.restype = count if name == "unicon_lanes" else None
    return library
