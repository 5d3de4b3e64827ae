"""Which files of an import have to be processed, which are unchanged and which are there twice."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing.file_processing import Fingerprint, ImportTask
from unicon.motion.importing.import_report import FileRecord


@dataclass(frozen=True)
class FoundFile:
    """A file and what its bytes say."""

    task: ImportTask
    mark: Fingerprint

    @property
    def origin(self) -> str:
        """The file, e.g. archive.zip/folder/take.bvh."""
        return self.task.file.origin


@dataclass(frozen=True)
class PlanOptions:
    """What a person asks for."""

    source: str = ""
    """Source of all files, as a person says."""
    licence: str = ""
    """Licence of all files, as a person says."""
    again: bool = False
    """Whether to process unchanged files, too."""
    prune: bool = False
    """Whether the clips of files that are not found any more leave the library."""


class ImportPlan(NamedTuple):
    """What becomes of each file."""

    to_do: list[ImportTask]
    """To be processed, the largest first, so that the last ones keep all cores busy."""
    pending: dict[str, FileRecord]
    """Of each file to be processed by its origin: its record as far as it is known."""
    settled: list[FileRecord]
    """Records that are final already."""
    leaving: set[str]
    """Origins whose clips leave the library, be it for new ones of the same file."""
    unchanged: int
    """How many files need nothing done."""


def plan_import(
    found: Sequence[FoundFile],
    known: Mapping[str, FileRecord],
    infos: Sequence[ClipInfo],
    work: Path,
    options: PlanOptions,
) -> ImportPlan:
    """Return what is to be done.

    A file whose bytes another one has is not processed: clips are not added twice.

    Args:
        found: the files, in the order of their origins.
        known: records of the last imports by origin.
        infos: the library's clips.
        work: where results are left.
        options: what a person asks for.
    """
    names, origins = {info.name for info in infos}, {entry.origin for entry in found}
    known = {
        origin: _with_given(record, options) if origin in origins else record
        for origin, record in known.items()
    }
    unchanged = {entry.origin for entry in found if not options.again and _is_unchanged(entry, known, names)}
    stay = [] if options.prune else [record for record in known.values() if record.origin not in origins]
    owners = {record.content: record.origin for record in stay if not record.duplicate_of}
    for entry in sorted(found, key=lambda entry: entry.origin not in unchanged):
        owners.setdefault(entry.mark.content, entry.origin)
    stored = {info.origin for info in infos if info.origin}
    plan = ImportPlan([], {}, stay, stored - origins if options.prune else set(), len(unchanged))
    for entry in found:
        content, key, size, error = entry.mark
        record = _with_given(FileRecord(entry.origin, content, key), options)
        plan.leaving.add(entry.origin)
        if error:
            plan.settled.append(replace(record, refused=error))
        elif owners[content] != entry.origin:
            plan.settled.append(replace(record, duplicate_of=owners[content]))
        elif entry.origin in unchanged:
            plan.settled.append(known[entry.origin])
            plan.leaving.remove(entry.origin)
        else:
            plan.to_do.append(replace(entry.task, result=work / f"{key}.npz", size=size))
            plan.pending[entry.origin] = record
    plan.to_do.sort(key=lambda task: (-task.size, task.file.origin))
    return plan


def _with_given(record: FileRecord, options: PlanOptions) -> FileRecord:
    return replace(
        record,
        source=options.source or record.source,
        licence=options.licence or record.licence,
    )


def _is_unchanged(entry: FoundFile, known: Mapping[str, FileRecord], names: Container[str]) -> bool:
    record = known.get(entry.origin)
    return (
        record is not None
        and not record.duplicate_of
        and record.key == entry.mark.key != ""
        and all(name in names for name in record.clips)
    )
