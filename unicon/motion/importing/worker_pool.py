"""Runs one function over many tasks in processes that may die without taking the rest with them."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from multiprocessing.context import BaseContext
from typing import Any, NamedTuple, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Died(NamedTuple):
    """The result of a task whose process was killed, mostly for want of memory."""

    reason: str = "its process was killed, perhaps for want of memory"


def core_count() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_all(
    function: Callable[[Task], Result], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[Task, Result | Died]]:
    """Yield each task with its result, in the order in which they are done.

    With one job all happens in this process. A task whose process dies is tried once more by itself;
    when it dies again, its result says so. The function and the tasks have to be picklable.
    """
    if jobs <= 1 or len(tasks) <= 1:
        for task in tasks:
            yield task, function(task)
        return
    suspects: list[Task] = []
    waiting = list(reversed(tasks))
    while waiting:
        yield from _run_until_broken(function, waiting, jobs, suspects)
    for task in suspects:
        alone: list[Task] = []
        yield from _run_until_broken(function, [task], 1, alone)
        if alone:
            yield task, Died()


def _run_until_broken(
    function: Callable[[Task], Result], waiting: list[Task], jobs: int, suspects: list[Task]
) -> Iterator[tuple[Task, Result]]:
    """Work off ``waiting`` from its end; when a process dies, put what was under way into ``suspects``."""
    running: dict[Future[Result], Task] = {}
    executor = _new_executor(function, jobs)
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                running[executor.submit(function, waiting[-1])] = waiting[-1]
                waiting.pop()
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                result = future.result()
                yield running.pop(future), result
    except BrokenProcessPool:
        suspects.extend(running.values())
    finally:
        _stop(executor)


def _begin_process() -> None:
    """Leave Ctrl-C to the first process, and end with it however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _context(function: Callable[..., Any]) -> BaseContext:
    """Return how processes begin: as forks of one that has imported what the function needs, and no more."""
    context = multiprocessing.get_context("forkserver")
    while isinstance(function, partial):
        function = function.func
    context.set_forkserver_preload(["__main__", function.__module__])
    return context


def _new_executor(function: Callable[..., Any], jobs: int) -> ProcessPoolExecutor:
    """Return fresh processes, each with one thread for linear algebra."""
    with _one_thread():
        executor = ProcessPoolExecutor(
            jobs,
            mp_context=_context(function),
            initializer=_begin_process,
        )
        for _ in range(jobs):
            executor.submit(os.getpid)
    return executor


def _stop(executor: ProcessPoolExecutor) -> None:
    """End the processes at once: what they were doing is done again next time."""
    processes = list((executor._processes or {}).values())
    executor.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.terminate()
    for process in processes:
        process.join()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Set what numpy's libraries read once, when they are loaded in a new process."""
    before = {name: os.environ.get(name) for name in _THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(_THREAD_VARIABLES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
