"""Which library a command works on where none is named."""

from __future__ import annotations

import os
from pathlib import Path

from rich.console import Console

from unicon.motion.fetch import fetch
from unicon.motion.library import ClipLibrary

LIBRARY_VARIABLE = "UNICON_LIBRARY"


def open_library(folder: Path | None, console: Console) -> ClipLibrary:
    """Return the library of a folder; without one that of $UNICON_LIBRARY, else the fetched one.

    Raises:
        UniconError: when it cannot be opened or fetched.
    """
    chosen = folder or os.environ.get(LIBRARY_VARIABLE)
    return ClipLibrary(Path(chosen)) if chosen else fetch(console)
