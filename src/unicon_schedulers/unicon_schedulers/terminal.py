"""A terminal that gives every key at once, and is as it was afterwards whatever happens."""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from types import TracebackType

from unicon.errors import UniconError


class KeyTerminal:
    """Standard input without line editing and echo; Ctrl-C is a signal as ever.

    Raises:
        UniconError: when standard input is no terminal.
    """

    def __init__(self) -> None:
        if not sys.stdin.isatty():
            raise UniconError(
                "standard input is no terminal, so there are no keys to read; start it in a terminal "
                "of its own (over ssh: ssh -t)"
            )
        self._file = sys.stdin.fileno()
        self._before = termios.tcgetattr(self._file)

    def __enter__(self) -> KeyTerminal:
        tty.setcbreak(self._file)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        termios.tcsetattr(self._file, termios.TCSADRAIN, self._before)
        print(flush=True)

    def read(self, patience_s: float) -> str:
        """Return what was typed, after waiting for so long at most; empty where nothing was."""
        if not select.select([self._file], [], [], max(patience_s, 0.0))[0]:
            return ""
        return os.read(self._file, 1024).decode(errors="replace")

    def show(self, line: str) -> None:
        """Write over the last line."""
        width = os.get_terminal_size(self._file).columns or 80
        print(f"\r\x1b[K{line[: width - 1]}", end="", flush=True)
