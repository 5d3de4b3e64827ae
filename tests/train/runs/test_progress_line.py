import io

from rich.console import Console

from tests.train.linear_quadratic import LinearQuadratic, make_learner
from unicon.train.runs.progress_line import ProgressLine, time_left


def test_time_left_is_said_in_hours_minutes_and_seconds():
    assert time_left(7384.2) == "2:03:04 left"
    assert time_left(61.0) == "1:01 left"
    assert time_left(None) == "until Ctrl-C"


def test_without_a_terminal_lines_come_now_and_then_only():
    report = make_learner(LinearQuadratic(num_envs=8)).iterate(0.0)
    console = Console(file=io.StringIO())
    with ProgressLine(console, every_s=1000.0) as line:
        for _ in range(5):
            line.show(report, 10.0)
    assert console.file.getvalue().count("\n") == 1
    assert "0:10 left" in console.file.getvalue()


def test_on_a_terminal_it_stays_one_line():
    report = make_learner(LinearQuadratic(num_envs=8)).iterate(0.0)
    console = Console(file=io.StringIO(), force_terminal=True, width=400)
    with ProgressLine(console, every_s=0.0) as line:
        line.show(report, 10.0)
    assert "samples" in console.file.getvalue()
