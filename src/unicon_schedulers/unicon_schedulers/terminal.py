"""A terminal that gives every key at once, and is as it was afterwards whatever happens."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import termios
import tty
from types import FrameType, TracebackType

from unicon.errors import UniconError


class KeyTerminal:
    """Standard input without line editing and echo; Ctrl-C and Ctrl-Z are signals as ever.

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
        signal.signal(signal.SIGTSTP, self._suspend)
        signal.signal(signal.SIGCONT, self._resume)
        tty.setcbreak(self._file)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        signal.signal(signal.SIGCONT, signal.SIG_DFL)
        self._restore()
        self.write("\n")

    def read(self, patience_s: float) -> str | None:
        """Return what was typed, after waiting for so long at most; none when the terminal went away."""
        try:
            if not select.select([self._file], [], [], max(patience_s, 0.0))[0]:
                return ""
            return os.read(self._file, 1024).decode(errors="replace") or None
        except OSError:
            return None

    def show(self, line: str) -> None:
        """Write over the last line."""
        with contextlib.suppress(OSError):
            width = os.get_terminal_size(self._file).columns or 80
            self.write(f"\r\x1b[K{line[: width - 1]}")

    def write(self, text: str) -> None:
        """Write at once; nothing where the terminal went away."""
        with contextlib.suppress(OSError):
            os.write(sys.stdout.fileno(), text.encode())

    def _restore(self) -> None:
        # a terminal that went away has nothing to be restored
        with contextlib.suppress(termios.error):
            termios.tcsetattr(self._file, termios.TCSADRAIN, self._before)

    def _suspend(self, number: int, frame: FrameType | None) -> None:
        self._restore()
        os.kill(os.getpid(), signal.SIGSTOP)

    def _resume(self, number: int, frame: FrameType | None) -> None:
        with contextlib.suppress(termios.error):
            tty.setcbreak(self._file)
