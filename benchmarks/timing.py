"""Times competitors in turns, so that what else the machine does disturbs all of them alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np


class Seconds(NamedTuple):
    """How long some work takes [s]."""

    clock: float
    core: float
    """Processor time: what the clock would say if nothing else ran."""


def median_seconds(work: Callable[[], Any], turns: int) -> Seconds:
    """Return the median times of some work on one thread."""
    seconds = []
    for _ in range(turns):
        began, core_began = time.perf_counter(), time.process_time()
        work()
        seconds.append((time.perf_counter() - began, time.process_time() - core_began))
    return Seconds(*np.median(seconds, axis=0).tolist())


def median_core_seconds(works: Mapping[str, Callable[[], Any]], turns: int) -> dict[str, float]:
    """Return the median processor time of each work [s] on one thread; they take turns."""
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(turns):
        for name, work in works.items():
            began = time.process_time()
            work()
            seconds[name].append(time.process_time() - began)
    return {name: float(np.median(values)) for name, values in seconds.items()}
