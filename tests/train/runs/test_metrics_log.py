import json

import pytest

from tests.train.linear_quadratic import LinearQuadratic, make_learner
from unicon.train.runs.metrics_log import MetricsLog, row_of


def _iterations(folder):
    return [json.loads(line)["iteration"] for line in (folder / "metrics.jsonl").read_text().splitlines()]


def _write(folder, first, last):
    log = MetricsLog(folder, first - 1, tensorboard=False)
    for iteration in range(first, last + 1):
        log.write(iteration, {"reward/total": 0.5})
    log.close()


def test_rows_after_the_iteration_that_a_run_goes_on_from_are_dropped(tmp_path):
    _write(tmp_path, 1, 6)
    _write(tmp_path, 4, 5)
    assert _iterations(tmp_path) == [1, 2, 3, 4, 5]


def test_a_line_that_a_crash_cut_off_is_dropped(tmp_path):
    _write(tmp_path, 1, 3)
    with (tmp_path / "metrics.jsonl").open("a") as file:
        file.write('{"iterat')
    _write(tmp_path, 4, 4)
    assert _iterations(tmp_path) == [1, 2, 3, 4]


def test_a_row_has_reward_terms_and_what_the_update_did():
    report = make_learner(LinearQuadratic(num_envs=8)).iterate(0.0)
    row = row_of(report, seconds=2.0)
    assert row["time/samples"] == 128
    assert row["reward/root_position"] == report.episodes.terms.root_position
    assert row["policy/kl"] == report.update.kl
    assert all(isinstance(value, int | float) for value in row.values())


def test_tensorboard_reads_what_was_written(tmp_path):
    pytest.importorskip("tensorboard")
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    log = MetricsLog(tmp_path)
    log.write(3, {"reward/total": 0.25})
    log.close()
    events = EventAccumulator(str(tmp_path / "tensorboard"))
    events.Reload()
    (event,) = events.Scalars("reward/total")
    assert (event.step, event.value) == (3, 0.25)
