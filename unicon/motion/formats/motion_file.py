"""Files that hold motions: alone, in folders and in zip archives, all read in the same way.

What counts as a motion is told by the suffix. DeepMimic's files are called .txt or .json as many others
are, so of these only those count that begin as its JSON does; a file named by itself always counts.
"""

from __future__ import annotations

import lzma
import os
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import lru_cache
from pathlib import Path, PurePosixPath

from unicon.errors import InputFileError

MOTION_SUFFIXES = (".amc", ".bvh", ".json", ".npz", ".txt")
"""Of the files that there are readers for."""
ARCHIVE_SUFFIX = ".zip"

_AMBIGUOUS_SUFFIXES = (".json", ".txt")
_HEAD_BYTES = 4096
BROKEN_ARCHIVE = (
    zipfile.BadZipFile,
    lzma.LZMAError,
    zlib.error,
    EOFError,
    NotImplementedError,
    RuntimeError,
)
"""What zipfile raises for archives that are damaged, encrypted, or packed in a way that it does not know."""


@dataclass(frozen=True)
class MotionFile:
    """A file, on its own or in an archive; it is read only when its content is asked for."""

    name: str
    """Its name without folders and suffix."""
    origin: str
    """Where it is, for people: the path, or archive.zip/folder/take.bvh."""
    suffix: str
    """In small letters, e.g. ``.bvh``."""
    path: Path
    """The file itself, or the archive that it is in."""
    member: str = ""
    """Its name in the archive; empty for a file on its own."""

    @classmethod
    def from_path(cls, path: Path) -> MotionFile:
        """Return the file at a path."""
        return cls(path.stem, str(path), path.suffix.lower(), path)

    def read(self) -> bytes:
        """Return the content.

        Raises:
            InputFileError: when it cannot be read.
        """
        try:
            return _open_archive(self.path).read(self.member) if self.member else self.path.read_bytes()
        except OSError as error:
            raise InputFileError(f"{self.origin}: cannot be read ({error.strerror or error})") from error
        except (*BROKEN_ARCHIVE, KeyError) as error:
            raise InputFileError(f"{self.origin}: cannot be unpacked ({error}); pack it again") from error

    def sibling(self, pattern: str) -> MotionFile | None:
        """Return another file of the same folder whose name matches, e.g. ``*.asf``.

        Of several, the one whose stem is the longest beginning of this file's name: 09.asf for 09_06.amc.
        None where there is none, or several of which none fits in this way.

        Raises:
            InputFileError: when the folder cannot be read.
        """
        others = sorted(name for name in self._folder() if fnmatch(name.lower(), pattern.lower()))
        fitting = [name for name in others if self.name.startswith(PurePosixPath(name).stem)]
        if not fitting and len(others) > 1:
            return None
        best = max(fitting or others, key=len, default=None)
        return None if best is None else self._beside(best)

    def _folder(self) -> list[str]:
        """Return the names of the files beside this one."""
        try:
            if not self.member:
                return [entry.name for entry in self.path.parent.iterdir() if entry.is_file()]
            folder = PurePosixPath(self.member).parent
            members = [PurePosixPath(name) for name in _open_archive(self.path).namelist()]
            return [member.name for member in members if member.parent == folder]
        except OSError as error:
            raise InputFileError(f"{self.path.parent}: cannot be read ({error.strerror or error})") from error
        except BROKEN_ARCHIVE as error:
            raise InputFileError(f"{self.path}: is no whole archive ({error})") from error

    def _beside(self, name: str) -> MotionFile:
        if not self.member:
            return MotionFile.from_path(self.path.with_name(name))
        return _in_archive(self.path, str(PurePosixPath(self.member).with_name(name)))


def find_motion_files(paths: Iterable[Path]) -> list[MotionFile]:
    """Return the motions at paths: files, folders (with all they hold) and zip archives, in this order.

    A damaged archive in a folder is returned as a file too, so that reading it says what is wrong with it.

    Raises:
        InputFileError: when a path does not exist, or is of a kind that there is no reader for.
    """
    found = [file for path in paths for file in _find(Path(path))]
    return list({(file.path.absolute(), file.member): file for file in found}.values())


def is_deepmimic(head: bytes) -> bool:
    """Tell whether a file that begins like this may be one of DeepMimic's: JSON with 'Frames'."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{") and b'"Frames"' in head


def _find(path: Path) -> Iterator[MotionFile]:
    if path.is_dir():
        yield from _find_in_folder(path)
    elif not path.exists():
        raise InputFileError(f"{path}: does not exist; expected a motion file, a folder or a zip archive")
    elif path.suffix.lower() == ARCHIVE_SUFFIX:
        yield from _find_in_archive(path)
    elif path.suffix.lower() in MOTION_SUFFIXES:
        yield MotionFile.from_path(path)
    else:
        known = ", ".join((*MOTION_SUFFIXES, ARCHIVE_SUFFIX))
        raise InputFileError(f"{path}: there is no reader for {path.suffix!r} files, only for {known}")


def _find_in_folder(folder: Path) -> Iterator[MotionFile]:
    for parent, folders, names in os.walk(folder):
        folders.sort()
        for path in (Path(parent, name) for name in sorted(names)):
            if path.suffix.lower() == ARCHIVE_SUFFIX:
                yield from _find_in_archive(path)
            elif _is_candidate(path.name) and _is_motion(path):
                yield MotionFile.from_path(path)


def _find_in_archive(path: Path) -> Iterator[MotionFile]:
    try:
        archive = _open_archive(path)
        members = [name for name in archive.namelist() if _is_candidate(name)]
        members = [name for name in members if _is_motion_member(archive, name)]
    except (OSError, *BROKEN_ARCHIVE):
        members = [""]
    for member in sorted(members):
        yield _in_archive(path, member)


def _in_archive(path: Path, member: str) -> MotionFile:
    if not member:
        return MotionFile.from_path(path)
    inside = PurePosixPath(member)
    return MotionFile(inside.stem, f"{path.name}/{member}", inside.suffix.lower(), path, member)


def _is_candidate(name: str) -> bool:
    """Leave out other kinds, and what systems hide (``._walk.bvh``, ``__MACOSX``)."""
    inside = PurePosixPath(name)
    hidden = any(part.startswith(".") or part == "__MACOSX" for part in inside.parts)
    return inside.suffix.lower() in MOTION_SUFFIXES and not hidden


def _is_motion(path: Path) -> bool:
    if path.suffix.lower() not in _AMBIGUOUS_SUFFIXES:
        return True
    try:
        with path.open("rb") as file:
            return is_deepmimic(file.read(_HEAD_BYTES))
    except OSError:
        return True  # whoever reads it is told why that fails


def _is_motion_member(archive: zipfile.ZipFile, name: str) -> bool:
    if PurePosixPath(name).suffix.lower() not in _AMBIGUOUS_SUFFIXES:
        return True
    try:
        with archive.open(name) as file:
            return is_deepmimic(file.read(_HEAD_BYTES))
    except (OSError, *BROKEN_ARCHIVE):
        return True


def _open_archive(path: Path) -> zipfile.ZipFile:
    about = path.stat()
    return _open_unchanged(path, about.st_mtime_ns, about.st_size, os.getpid())


@lru_cache(maxsize=4)
def _open_unchanged(path: Path, changed_ns: int, size: int, process: int) -> zipfile.ZipFile:
    """Keep archives open: reading the list of one with thousands of files takes longer than a file.

    Never across a change of the archive, and never shared with a forked process, which would move the
    position in the file under our feet.
    """
    return zipfile.ZipFile(path)
