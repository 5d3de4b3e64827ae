"""Times competitors in turns, so that what else the machine does disturbs all of them alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np


def median_seconds(work: Callable[[], Any], turns: int) -> float:
    """Return the median time of some work [s], by the clock."""
    seconds = []
    for _ in range(turns):
        began = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - began)
    return float(np.median(seconds))


def median_core_seconds(works: Mapping[str, Callable[[], Any]], turns: int) -> dict[str, float]:
    """Return the median processor time of each work [s]; they take turns.

    On one thread this is the time that the work takes on a core of its own.
    """
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(turns):
        for name, work in works.items():
            began = time.process_time()
            work()
            seconds[name].append(time.process_time() - began)
    return {name: float(np.median(values)) for name, values in seconds.items()}
