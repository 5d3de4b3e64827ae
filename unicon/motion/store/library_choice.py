"""Which library a command works on where none is named."""

from __future__ import annotations

import os
from pathlib import Path

from rich.console import Console

from unicon.motion.fetching.fetch import fetch
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_index import is_library

LIBRARY_VARIABLE = "UNICON_LIBRARY"
SHIPPED = Path(__file__).parents[3] / "motions"
"""The small library beside the code; absent where only the library was installed."""


def open_library(folder: Path | None, console: Console) -> ClipLibrary:
    """Return the library of a folder; without one that of $UNICON_LIBRARY, else the shipped one.

    Where the shipped one is absent, the motions that a package registry holds are fetched.

    Raises:
        UniconError: when it cannot be opened or fetched.
    """
    chosen = folder or os.environ.get(LIBRARY_VARIABLE)
    if not chosen and is_library(SHIPPED):
        chosen = SHIPPED
    return ClipLibrary(Path(chosen)) if chosen else fetch(console)
