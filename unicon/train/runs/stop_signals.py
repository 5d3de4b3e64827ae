"""Ctrl-C that lets the running step end, so that all can be saved."""

from __future__ import annotations

import signal
from types import TracebackType


class StopSignals:
    """Notes SIGINT and SIGTERM within a ``with``; a second one interrupts at once."""

    def __init__(self) -> None:
        self.asked = False
        """Whether one has come."""
        self._before: dict[signal.Signals, object] = {}

    def __enter__(self) -> StopSignals:
        """Begin to note them."""
        try:
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._note)
        except ValueError:
            pass  # only the main thread may; elsewhere the caller's handling stands
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Handle them as before."""
        for number, handler in self._before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]

    def _note(self, number: int, _: object) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
