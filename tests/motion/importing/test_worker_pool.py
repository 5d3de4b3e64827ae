"""Tests for worker_pool.py."""

from __future__ import annotations

import os
import signal
from pathlib import Path

from unicon.motion.importing.worker_pool import Died, run_all


def _square(task: int) -> int:
    return task * task


def _threads(task: int) -> str | None:
    return os.environ.get("OMP_NUM_THREADS")


def _die_of_three(task: int) -> int:
    if task == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return task


def _die_once(path: Path) -> str:
    if not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return path.name


def test_every_task_has_its_result_whatever_the_number_of_processes():
    for jobs in (1, 2):
        assert sorted(run_all(_square, [1, 2, 3, 4], jobs)) == [(1, 1), (2, 4), (3, 9), (4, 16)]


def test_other_processes_use_one_thread_each(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    assert [result for _, result in run_all(_threads, [1, 2], 2)] == ["1", "1"]
    assert os.environ["OMP_NUM_THREADS"] == "7"


def test_a_process_that_dies_takes_only_its_own_task_along():
    results = dict(run_all(_die_of_three, [1, 2, 3, 4, 5], 2))
    assert isinstance(results.pop(3), Died)
    assert results == {1: 1, 2: 2, 4: 4, 5: 5}


def test_what_died_once_is_tried_again(tmp_path):
    tasks = [tmp_path / "a", tmp_path / "b"]
    tasks[1].touch()
    assert sorted(run_all(_die_once, tasks, 2)) == [(tmp_path / "a", "a"), (tmp_path / "b", "b")]
