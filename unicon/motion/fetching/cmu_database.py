"""Fetches the CMU motion capture database from its own site: each subject's skeleton (.asf) and takes (.amc).

One connection at a time. Each file that is whole is listed with its sha256 in ``SHA256SUMS`` (`sha256sum
--check` reads it too) before it takes its place, so a later call goes on where an earlier one ended, and
finds files that were damaged since.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from unicon.cache import cache_folder
from unicon.errors import UniconError, UnknownNameError
from unicon.motion.catalogue.cmu_index import cmu_index
from unicon.motion.fetching.download import DownloadConfig, NotOnServerError, download
from unicon.motion.store.library_index import replace_file

BASE_URL = "http://mocap.cs.cmu.edu"
SUMS_FILE = "SHA256SUMS"
ABOUT_FILE = "README.txt"
ABOUT = """The data used in this project was obtained from mocap.cs.cmu.edu.
The database was created with funding from NSF EIA-0196217.

Free for all uses; it may be included in products that are sold, but the data itself may not be resold,
even in converted form.
"""
GIVE_UP_AFTER = 5
"""This many files that the server does not have, and none that it has: it is not the right server."""


@dataclass(frozen=True)
class CmuConfig:
    """What to fetch, and from where."""

    subjects: tuple[int, ...] = ()
    """Numbers of the subjects; all where none is given (some 2400 files, several gigabytes)."""
    out: Path | None = None
    """Folder for the files; one in the user's cache where it is not given."""
    base_url: str = BASE_URL
    """Address of the site, or of a copy of it."""


class Fetched(NamedTuple):
    """What a call did."""

    folder: Path
    new: int
    """Files that were fetched."""
    kept: int
    """Files that were there, whole."""
    missing: tuple[str, ...]
    """Files that the server does not have."""


def fetch_cmu(
    config: CmuConfig,
    console: Console,
    patience: DownloadConfig = DownloadConfig(),  # noqa: B008 - frozen
) -> Fetched:
    """Fetch what is not there yet.

    Raises:
        UnknownNameError: when there is no such subject.
        UniconError: when the server does not answer, the disk is full, or a file is not what it was when it
            was first fetched; what was fetched is kept.
    """
    names = file_names(config.subjects)
    if not config.base_url.startswith(("http://", "https://")):
        raise UniconError(
            f"the address is {config.base_url!r}, expected one that begins with http:// or https://"
        )
    folder = config.out or cache_folder() / "cmu"
    try:
        fetcher = _Fetcher(folder, config.base_url.rstrip("/"), patience)
        _fetch_all(fetcher, names, console)
    except OSError as error:
        raise UniconError(
            f"{folder}: cannot be written ({error.strerror or error}); make room or choose another folder"
        ) from error
    return fetcher.finish()


def _fetch_all(fetcher: _Fetcher, names: list[str], console: Console) -> None:
    size = TextColumn("{task.fields[megabytes]:.1f} MB")
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        size,
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("", total=len(names), megabytes=0.0)
        for name in names:
            progress.update(task, description=Path(name).name)
            fetcher.fetch(name, lambda: progress.update(task, megabytes=fetcher.bytes / 1e6))
            progress.advance(task)


def file_names(subjects: tuple[int, ...] = ()) -> list[str]:
    """Return the site's paths of the subjects' files, each skeleton before its takes.

    Raises:
        UnknownNameError: when there is no such subject.
    """
    takes = sorted(cmu_index())
    known = sorted({subject for subject, _ in takes})
    unknown = sorted(set(subjects) - set(known))
    if unknown:
        near = ", ".join(str(n) for n in sorted(sorted(known, key=lambda n: abs(n - unknown[0]))[:5]))
        raise UnknownNameError(
            f"there is no subject {unknown[0]} in the CMU database; the nearest are {near}"
        )
    return [
        name
        for subject in known
        if subject in subjects or not subjects
        for name in _of_subject(subject, takes)
    ]


def _of_subject(subject: int, takes: list[tuple[int, int]]) -> Iterator[str]:
    folder = f"subjects/{subject:02d}"
    yield f"{folder}/{subject:02d}.asf"
    for owner, trial in takes:
        if owner == subject:
            yield f"{folder}/{subject:02d}_{trial:02d}.amc"


class _Fetcher:
    """Fetches file after file into a folder."""

    def __init__(self, folder: Path, base_url: str, patience: DownloadConfig) -> None:
        self.folder, self._base_url, self._patience = folder, base_url, patience
        folder.mkdir(parents=True, exist_ok=True)
        (folder / ABOUT_FILE).write_text(ABOUT)
        self._sums = read_sums(folder / SUMS_FILE)
        replace_file(folder / SUMS_FILE, "".join(f"{s}  {name}\n" for name, s in self._sums.items()))
        self.new = self.kept = self.bytes = 0
        self.missing: list[str] = []
        self.changed: list[str] = []

    def fetch(self, name: str, tell: Callable[[], None] = lambda: None) -> None:
        """Fetch one file unless it is there, whole; ``tell`` is called whenever some of it has arrived."""
        path = self.folder / name
        if name in self._sums and path.exists() and sha256_of(path) == self._sums[name]:
            self.kept += 1
            return

        def count(arrived: int) -> None:
            self.bytes += arrived
            tell()

        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            part = download(f"{self._base_url}/{name}", path, self._patience, count)
        except NotOnServerError:
            self._miss(name)
            return
        self._accept(name, part, path)

    def _miss(self, name: str) -> None:
        self.missing.append(name)
        if len(self.missing) >= GIVE_UP_AFTER and not self.new + self.kept:
            raise UniconError(
                f"{self._base_url}: has none of the first {GIVE_UP_AFTER} files of the CMU database, "
                f"e.g. {name}; look at the address"
            )

    def _accept(self, name: str, part: Path, path: Path) -> None:
        found = sha256_of(part)
        if self._sums.get(name, found) != found:
            self.changed.append(name)
            return
        if name not in self._sums:
            self._sums[name] = found
            with (self.folder / SUMS_FILE).open("a") as sums:
                sums.write(f"{found}  {name}\n")
        part.replace(path)
        self.new += 1

    def finish(self) -> Fetched:
        """Return what was done.

        Raises:
            UniconError: when the server's files are others than before.
        """
        if self.changed:
            raise UniconError(
                f"{self.folder}: {len(self.changed)} files on the server have another sha256 than when they "
                f"were first fetched ({', '.join(self.changed[:3])}); they are left as .part, not used: to "
                f"take them, delete their lines from {SUMS_FILE} and call again"
            )
        return Fetched(self.folder, self.new, self.kept, tuple(self.missing))


def read_sums(path: Path) -> dict[str, str]:
    """Return the checksums by name; lines that are not whole are passed over."""
    sums = {}
    with suppress(FileNotFoundError):
        for line in path.read_text(errors="replace").splitlines():
            checksum, _, name = line.partition("  ")
            if len(checksum) == 64 and name:
                sums[name] = checksum
    return sums


def sha256_of(path: Path) -> str:
    """Return the checksum of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
