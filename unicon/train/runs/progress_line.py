"""The line that shows how a training goes: kept in place on a terminal, now and then a new one elsewhere."""

from __future__ import annotations

import time

from rich.console import Console
from rich.live import Live
from rich.text import Text

from unicon.train.learning.learner import IterationReport


class ProgressLine:
    """A line for every iteration; use it in a ``with``."""

    def __init__(self, console: Console, every_s: float) -> None:
        """Begin.

        Args:
            console: where to.
            every_s: how often a line is written where it cannot be kept in place [s].
        """
        self._console, self._every_s = console, every_s
        self._live = Live(console=console, auto_refresh=False) if console.is_terminal else None
        self._next = 0.0

    def __enter__(self) -> ProgressLine:
        """Begin to show."""
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the last line standing."""
        if self._live is not None:
            self._live.stop()

    def show(self, report: IterationReport, left_s: float | None) -> None:
        """Show an iteration and the time left [s], None where there is no end."""
        now = time.monotonic()
        if now < self._next:
            return
        text = Text(line_of(report, left_s))
        if self._live is not None:
            self._next = now + 0.2
            self._live.update(text, refresh=True)
        else:
            self._next = now + self._every_s
            self._console.print(text, soft_wrap=True)


def line_of(report: IterationReport, left_s: float | None) -> str:
    """Return an iteration in words."""
    episodes, update = report.episodes, report.update
    rate = report.new_samples / (report.collect_s + report.update_s)
    terms = " ".join(f"{term:.2f}" for term in episodes.terms)
    return (
        f"it {report.iteration} | {report.samples / 1e6:.2f} M samples, {rate / 1e3:.1f} k/s | "
        f"reward {episodes.reward:.3f} ({terms}) | {episodes.length:.0f} steps, "
        f"{episodes.survival:.0%} survive | KL {update.kl:.3f} lr {update.learning_rate:.1e} "
        f"std {report.std:.3f} | {time_left(left_s)}"
    )


def time_left(seconds: float | None) -> str:
    """Return a time in words."""
    if seconds is None:
        return "until Ctrl-C"
    minutes, rest = divmod(max(0, round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d} left" if hours else f"{minutes}:{rest:02d} left"
