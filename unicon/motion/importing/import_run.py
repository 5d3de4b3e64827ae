"""`unicon motions import`: many files into one library, in parallel, resumed and without doing work twice."""

from __future__ import annotations

import fcntl
import shutil
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from unicon.errors import UniconError
from unicon.motion.catalogue.split import SplitPlan, SplitSettings, split_clips
from unicon.motion.catalogue.split_file import write_split
from unicon.motion.cleaning import Overrides, load_overrides, shipped_overrides
from unicon.motion.clip_index import ClipInfo
from unicon.motion.formats.motion_file import MOTION_SUFFIXES, MotionFile, find_motion_files
from unicon.motion.importing.file_processing import UNREADABLE, ImportTask, fingerprint, process
from unicon.motion.importing.import_config import ImportConfig
from unicon.motion.importing.import_merge import Row, merge
from unicon.motion.importing.import_plan import FoundFile, ImportPlan, PlanOptions, plan_import
from unicon.motion.importing.import_report import (
    READABLE_FILE,
    REPORT_FILE,
    FileRecord,
    ImportReport,
    ImportRun,
    read_report,
    write_report,
)
from unicon.motion.importing.processed_file import ProcessedFile, load_processed
from unicon.motion.importing.worker_pool import Died, core_count, run_all
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_index import is_library
from unicon.motion.store.library_split import SPLIT_FILE, settings_of
from unicon.motion.store.library_writer import LibraryWriter

WORK_FOLDER = ".import"
"""Holds what is done of an import that has not ended yet."""

Pipeline = Callable[[ImportTask], ProcessedFile]


class ImportOutcome(NamedTuple):
    """What an import did."""

    report: ImportReport
    """On all files of the library."""
    run: ImportRun
    """This call of the command."""
    infos: list[ClipInfo]
    """The clips of the library now."""
    changed: bool
    """Whether the library was written."""

    def __str__(self) -> str:
        minutes = sum(info.seconds for info in self.infos) / 60
        size = f"{len(self.infos)} clip{'s' * (len(self.infos) != 1)}, {minutes:.1f} minutes"
        if not self.changed and not self.run.made:
            return f"nothing new: {self.run.unchanged} files are unchanged; the library has {size}"
        refused = len(self.report.refused)
        twice = sum(bool(record.duplicate_of) for record in self.report.files)
        return (
            f"the library has {size}; {self.run.made} files were processed in {self.run.seconds:.0f} s, "
            f"{self.run.unchanged} were unchanged; in all {refused} are refused and {twice} are there twice"
        )


def run_import(config: ImportConfig, console: Console, pipeline: Pipeline | None = None) -> ImportOutcome:
    """Bring motions into a library.

    Args:
        config: what to import, and how.
        console: where to show the progress.
        pipeline: what makes clips of a file; the whole chain where None.

    Raises:
        UniconError: when no motions are found, the folder is no library and not empty, another import is
            at work in it, no file can be used, or it cannot be written.
    """
    _check_folder(config.out)
    files = _find(config)
    try:
        with _locked(config.out) as work:
            return _Import(config, work, console, pipeline).run(files)
    except OSError as error:
        raise UniconError(
            f"{config.out}: cannot be written ({error.strerror or error}); make room or choose another --out"
        ) from error


def _find(config: ImportConfig) -> list[MotionFile]:
    """Return the files, without what lies in the library itself."""
    if not config.paths:
        raise UniconError("there is nothing to import; name a folder, a zip archive or a file of motions")
    out = config.out.absolute()
    files = [file for file in find_motion_files(config.paths) if out not in file.path.absolute().parents]
    if not files:
        places = ", ".join(str(path) for path in config.paths)
        raise UniconError(
            f"{places}: no motions found; expected {', '.join(MOTION_SUFFIXES)} files or zip archives of them"
        )
    return files


def _check_folder(folder: Path) -> None:
    """Refuse to write a library among files of other kinds; an import that came to nothing left its own."""
    ours = is_library(folder) or (folder / WORK_FOLDER).is_dir() or (folder / REPORT_FILE).is_file()
    if ours or not folder.exists():
        return
    if not folder.is_dir() or any(folder.iterdir()):
        raise UniconError(f"{folder}: is not empty and not a clip library; give a new folder as --out")


@contextmanager
def _locked(folder: Path) -> Iterator[Path]:
    """Keep a library for this import; yield the folder for its work."""
    work = folder / WORK_FOLDER
    work.mkdir(parents=True, exist_ok=True)
    with (work / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UniconError(f"{folder}: another import is at work in it; wait for its end") from None
        yield work


class _Import:
    """One import into a library that nobody else writes."""

    def __init__(self, config: ImportConfig, work: Path, console: Console, pipeline: Pipeline | None) -> None:
        self.config = config
        self.work = work
        self.console = console
        self.pipeline = pipeline
        self.jobs = config.jobs or core_count()
        self.old = ClipLibrary(config.out) if is_library(config.out) else None
        self.old_report = read_report(config.out)
        self.started = time.monotonic()

    def run(self, files: Sequence[MotionFile]) -> ImportOutcome:
        """Look at the files, process what is new, write the library and its report."""
        plan = self._plan(self._look_at(files))
        spared_s = self._process(plan.to_do)
        merged = merge(self.old, plan, mirror=self.config.mirror)
        rows = _divided(merged.rows, settings_of(self.config.out))
        changed = self._write(rows, must=bool(plan.to_do))
        seconds = round(time.monotonic() - self.started + spared_s / self.jobs, 1)
        run = ImportRun(seconds, self.jobs, len(plan.to_do), plan.unchanged)
        infos = [row.info for row in rows]
        report = self._write_report(merged.records, run, infos, changed)
        shutil.rmtree(self.work, ignore_errors=True)
        if not infos:
            raise UniconError(
                f"none of the {len(files)} files could be used ({report.refused[0].refused}); "
                f"all reasons are in {self.config.out / READABLE_FILE}"
            )
        return ImportOutcome(report, run, infos, changed)

    def _look_at(self, files: Sequence[MotionFile]) -> list[FoundFile]:
        """Return the files in the order of their origins, with their fingerprints."""
        overrides = _overrides(self.config.overrides)
        tasks = [ImportTask(file, overrides.of(file.origin)) for file in _with_own_origins(files)]
        with self.console.status(f"looking at {len(tasks)} files ..."):
            looked = run_all(fingerprint, tasks, self.jobs)
            marks = {t.file.origin: UNREADABLE if isinstance(m, Died) else m for t, m in looked}
        return [FoundFile(task, marks[task.file.origin]) for task in tasks]

    def _plan(self, found: Sequence[FoundFile]) -> ImportPlan:
        """Return what is to be done; doing all again starts without what an interrupted run left."""
        if self.config.again:
            for leftover in self.work.glob("*.npz"):
                leftover.unlink()
        config = self.config
        options = PlanOptions(config.source, config.licence, config.again, config.prune)
        known = {record.origin: record for record in self.old_report.files}
        return plan_import(found, known, self.old.infos if self.old else (), self.work, options)

    def _process(self, tasks: Sequence[ImportTask]) -> float:
        """Process all files; return the seconds of a core that an interrupted run had spent on them."""
        spared_s = sum(done.seconds for task in tasks if (done := load_processed(task.result)))
        count = 0
        with _progress(self.console, tasks) as advance:
            try:
                for task, result in run_all(partial(process, pipeline=self.pipeline), tasks, self.jobs):
                    if isinstance(result, Died):
                        ProcessedFile(refused=result.reason, retry=True).save(task.result)
                    count += 1
                    advance(task, count)
            except KeyboardInterrupt:
                self.console.print(
                    f"stopped; {count} of {len(tasks)} files are done and kept: "
                    "the same command goes on from there"
                )
                raise
        return spared_s

    def _write(self, rows: Sequence[Row], must: bool) -> bool:
        """Write the library and its split unless they would stay the same; say whether they were."""
        infos = [row.info for row in rows]
        if not infos or (self.old and not must and infos == list(self.old.infos)):
            return False
        with LibraryWriter(self.config.out) as writer:
            for row in rows:
                writer.add_rows(row.info, row.values())
            writer.commit()
        plan = SplitPlan(settings_of(self.config.out), {info.name: info.split for info in infos})
        write_split(plan, self.config.out / SPLIT_FILE)
        return True

    def _write_report(
        self, records: Sequence[FileRecord], run: ImportRun, infos: Sequence[ClipInfo], changed: bool
    ) -> ImportReport:
        """Write the report unless it stays the same; its runs begin anew when all files were made anew."""
        before = self.old_report.runs if run.unchanged else ()
        report = ImportReport(tuple(records), (*before, run) if run.made else before)
        if changed or report != self.old_report:
            write_report(self.config.out, report, infos)
        return report


def _divided(rows: Sequence[Row], settings: SplitSettings) -> list[Row]:
    """Return the rows with their sides of the split."""
    sides = split_clips([row.info for row in rows], settings).sides
    return [replace(row, info=replace(row.info, split=sides[row.info.name])) for row in rows]


def _overrides(path: Path | None) -> Overrides:
    """Return the overrides that come with the program, and those of a file after them."""
    own = load_overrides(path).orders if path else ()
    return Overrides(shipped_overrides().orders + own)


def _with_own_origins(files: Sequence[MotionFile]) -> list[MotionFile]:
    """Return the files in the order of their origins; archives of the same name are told apart by folder."""
    counts = Counter(file.origin for file in files)
    told_apart = [
        replace(file, origin=f"{file.path}/{file.member}") if counts[file.origin] > 1 else file
        for file in files
    ]
    return sorted(told_apart, key=lambda file: file.origin)


@contextmanager
def _progress(console: Console, tasks: Sequence[ImportTask]) -> Iterator[Callable[[ImportTask, int], None]]:
    """Show how far the work is, by the files' sizes; yield what to call when one is done."""
    columns = (
        BarColumn(),
        TextColumn("{task.fields[count]}/{task.fields[files]} files, {task.fields[rate]:.1f}/s, left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as progress:
        total = sum(task.size for task in tasks)
        bar = progress.add_task("", total=total, count=0, files=len(tasks), rate=0.0)
        started = time.monotonic()

        def advance(task: ImportTask, count: int) -> None:
            rate = count / max(time.monotonic() - started, 1e-3)
            progress.update(bar, advance=task.size, count=count, rate=rate)

        yield advance
