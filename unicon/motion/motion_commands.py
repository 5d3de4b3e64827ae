"""`unicon motions import|list|stats|tree|split`: a library on a person's terminal."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from unicon.motion.catalogue.split import SplitSettings
from unicon.motion.importing.import_config import ImportConfig

Library = Annotated[Path | None, tyro.conf.Positional]


@dataclass(frozen=True)
class MotionsImport:
    """Bring motions into a clip library: read, clean, retarget, measure and label them.

    Files that have not changed are skipped, and an import that was stopped goes on where it was. What
    became of each file stands in import_report.md in the library's folder.
    """

    config: Annotated[ImportConfig, tyro.conf.arg(name="")]

    def run(self, console: Console) -> int:
        """Import and say what became of the files."""
        from unicon.motion.importing.import_run import run_import

        outcome = run_import(self.config, console)
        console.print(f"{self.config.out}: {outcome}", soft_wrap=True)
        return 0


@dataclass(frozen=True)
class MotionsList:
    """List the clips of a library."""

    library: Library = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    name: str = ""
    """Only clips whose names contain this."""
    label: str = ""
    """Only clips of this class, e.g. walking or walking/forward."""

    def run(self, console: Console) -> int:
        """Print a table of them."""
        from rich.table import Table

        from unicon.errors import UnknownNameError
        from unicon.motion.store.library_choice import open_library

        library = open_library(self.library, console)
        infos = sorted(library.infos, key=lambda info: info.name)
        infos = [info for info in infos if self.name.lower() in info.name.lower()]
        wanted = self.label.strip("/")
        infos = [info for info in infos if not wanted or f"{info.label}/".startswith(f"{wanted}/")]
        if not infos:
            raise UnknownNameError(
                f"{library.folder}: no clip fits; `unicon motions tree` shows the classes of its "
                f"{len(library)} clips"
            )
        table = Table()
        for heading in ("motion", "seconds", "class", "split", "marks", "source", "licence"):
            table.add_column(heading, no_wrap=True, justify="right" if heading == "seconds" else "left")
        for info in infos:
            words = (info.label, info.split, ", ".join(info.marks), info.source, info.licence)
            table.add_row(info.name, f"{info.seconds:.1f}", *words)
        console.print(table)
        return 0


@dataclass(frozen=True)
class MotionsStats:
    """Say how large and how good a library is, and how large the paper's sub-datasets are in it."""

    library: Library = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    json: Path | None = None
    """File to write the figures to as well."""

    def run(self, console: Console) -> int:
        """Print the figures."""
        from unicon.motion.store.library_choice import open_library
        from unicon.motion.store.library_stats import show_stats

        show_stats(open_library(self.library, console), self.json, console)
        return 0


@dataclass(frozen=True)
class MotionsTree:
    """Show the tree of classes with the clips and seconds of each."""

    library: Library = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""

    def run(self, console: Console) -> int:
        """Print the tree."""
        from unicon.motion.catalogue.class_tree import class_tree, rich_tree
        from unicon.motion.store.library_choice import open_library

        library = open_library(self.library, console)
        console.print(rich_tree(class_tree(library.infos), str(library.folder)))
        return 0


@dataclass(frozen=True)
class MotionsSplit:
    """Divide a library into training and test clips, class by class; all copies of a take on one side."""

    library: Library = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    settings: Annotated[SplitSettings, tyro.conf.arg(name="")] = field(default_factory=SplitSettings)
    file: Path | None = None
    """Where to write the split; split.yaml in the library's folder where it is not given."""
    use: Path | None = None
    """Take the sides from this file, which may have been changed by hand, instead of dividing anew."""

    def run(self, console: Console) -> int:
        """Divide, write the file and the library's index, and print the shares."""
        from unicon.motion.store.library_choice import open_library
        from unicon.motion.store.library_split import divide, split_table

        library = open_library(self.library, console)
        console.print(split_table(divide(library, self.settings, self.file, self.use)))
        return 0
