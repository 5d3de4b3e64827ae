"""Where the project keeps what it fetches and builds for this user: $UNICON_CACHE, or the user's cache."""

from __future__ import annotations

import os
from pathlib import Path

CACHE_VARIABLE = "UNICON_CACHE"


def cache_folder() -> Path:
    """Return the folder: $UNICON_CACHE, or ``unicon`` in the user's cache."""
    chosen = os.environ.get(CACHE_VARIABLE)
    base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return Path(chosen) if chosen else base / "unicon"
