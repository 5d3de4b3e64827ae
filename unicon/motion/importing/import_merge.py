"""Joins what a library has with what an import made, into its new rows."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import NamedTuple

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.motion.catalogue import classify, describe, provenance_of, take_of
from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing.import_plan import ImportPlan
from unicon.motion.importing.import_report import FileRecord
from unicon.motion.importing.processed_file import ProcessedFile, load_processed
from unicon.motion.store.library import ClipLibrary, as_rows, as_states

MIRRORED = "_mirrored"
"""Ends the name of a left-right mirrored copy."""


@dataclass(frozen=True)
class Row:
    """A clip on its way into the new library."""

    info: ClipInfo
    rows: np.ndarray
    """``(T, 83)``; those of the old library stay mapped and unread until they are written."""
    mirrored: bool = False
    """Whether left and right change places when it is written."""

    def values(self) -> np.ndarray:
        """Return the rows to be written."""
        if not self.mirrored:
            return self.rows
        return as_rows(HUMANOID.mirror(as_states(np.asarray(self.rows))))


class Merged(NamedTuple):
    """What the library will be."""

    records: list[FileRecord]
    """Of all files, in the order of their origins."""
    rows: list[Row]
    """All clips, in the order of their names."""


def merge(old: ClipLibrary | None, plan: ImportPlan, *, mirror: bool) -> Merged:
    """Join the clips that stay with those that the plan's files have become."""
    rows = [row for row in _own_rows(old) if row.info.origin not in plan.leaving]
    taken = {row.info.name for row in rows}
    records = list(plan.settled)
    for task in sorted(plan.to_do, key=lambda task: task.file.origin):
        result = load_processed(task.result) or ProcessedFile(refused="its result was lost", retry=True)
        new = rows_of_file(result, task.file.origin, taken)
        records.append(_completed(plan.pending[task.file.origin], result, new))
        rows += new
    by_origin = {record.origin: record for record in records}
    rows = [_catalogued(row, by_origin.get(row.info.origin)) for row in rows]
    rows += _mirrored_copies(rows) if mirror else []
    return Merged(
        sorted(records, key=lambda record: record.origin), sorted(rows, key=lambda row: row.info.name)
    )


def _own_rows(library: ClipLibrary | None) -> Iterator[Row]:
    """Yield a library's clips without the mirrored copies, which are made anew from them."""
    infos = library.infos if library else ()
    origins = {info.name: info.origin for info in infos}
    for info, first in zip(infos, library.first_frames if library else (), strict=True):
        original = info.name.removesuffix(MIRRORED)
        if library and (original == info.name or origins.get(original) != info.origin):
            yield Row(info, library.array[first : first + info.frames])


def rows_of_file(result: ProcessedFile, origin: str, taken: set[str]) -> list[Row]:
    """Return a file's clips under names that are not taken yet, and take these."""
    rows = []
    for clip in result.clips:
        name = free_name(clip.info.name, origin, taken)
        taken.add(name)
        info = replace(clip.info, name=name, origin=origin, frames=len(clip.rows))
        rows.append(Row(info, clip.rows))
    return rows


def free_name(name: str, origin: str, taken: Container[str]) -> str:
    """Return a name that is not taken: with its folder or archive before it, else with a number behind it."""
    name = name.replace("/", "_")
    if name not in taken:
        return name
    folders = [part.removesuffix(".zip") for part in PurePosixPath(origin).parts[:-1]]
    longer = f"{folders[-1]}_{name}" if folders and folders[-1] != "/" else name
    number, candidate = 2, longer
    while candidate in taken:
        candidate = f"{longer}_{number}"
        number += 1
    return candidate


def _completed(record: FileRecord, result: ProcessedFile, rows: Sequence[Row]) -> FileRecord:
    """Return a file's record with what came out of it."""
    first = rows[0].info if rows else None
    return replace(
        record,
        key="" if result.retry else record.key,
        family=result.family,
        clips=tuple(row.info.name for row in rows),
        decisions=result.decisions,
        refused=result.refused,
        source=record.source or (first.source if first else ""),
        licence=record.licence or (first.licence if first else ""),
        label=first.label if first else "",
        seconds=result.seconds,
        frames=sum(len(row.rows) for row in rows),
    )


def _catalogued(row: Row, record: FileRecord | None) -> Row:
    """Return a row with its class, take, source and licence by today's rules."""
    info = row.info
    if record is None:
        return row
    provenance = provenance_of(info.origin, record.source, record.licence)
    return replace(
        row,
        info=replace(
            info,
            label=classify(describe(info.origin, record.label)),
            take=take_of(info.origin),
            source=provenance.source,
            licence=provenance.licence,
        ),
    )


def _mirrored_copies(rows: Sequence[Row]) -> list[Row]:
    """Return the mirrored copies of clips; a name that is taken has its copy already."""
    taken = {row.info.name for row in rows}
    return [
        Row(replace(row.info, name=row.info.name + MIRRORED), row.rows, mirrored=True)
        for row in rows
        if row.info.name + MIRRORED not in taken
    ]
