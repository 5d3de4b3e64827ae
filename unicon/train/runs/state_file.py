"""Files that say where a training stands: a kill leaves the old one or the new one, never half of one."""

from __future__ import annotations

import os
from pathlib import Path

from unicon.errors import UniconError


def write_in_one_step(path: Path, text: str) -> None:
    """Write a text, so that the file changes all at once.

    Raises:
        UniconError: when it cannot be written, e.g. as the disk is full; the old file stays.
    """
    part = path.with_name(f".{path.name}.part")
    try:
        with part.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise UniconError(f"{path}: cannot be written ({error.strerror}); make room and go on") from error
