"""What a person asks of an import."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro


@dataclass(frozen=True)
class ImportConfig:
    """What to import, and how."""

    paths: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Folders, archives and files of motions."""
    out: Path
    """Folder of the library; what it holds already stays."""
    overrides: Path | None = None
    """YAML file with decisions that overrule the cleaning."""
    source: str = ""
    """Where the motions come from; told by their names where it is not given."""
    licence: str = ""
    """Their licence; told by their names where it is not given."""
    jobs: int = 0
    """Processes; 0: one a core."""
    mirror: bool = False
    """Give the library left-right mirrored copies of all its clips, named NAME_mirrored; without it, none."""
    prune: bool = False
    """Remove clips whose files are not found in the paths any more."""
    again: bool = False
    """Process all files, even those that have not changed."""
