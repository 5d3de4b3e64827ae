"""One source file on its way into a library: read, recognise, clean, retarget, measure."""

from __future__ import annotations

import hashlib
import tempfile
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from unicon.errors import UniconError
from unicon.motion.catalogue import classify, cmu_take, describe
from unicon.motion.cleaning import Hints, Order, Overrides, clean
from unicon.motion.clip import Clip, load_clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.formats.array_file import list_arrays
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.formats.readers import read_motion
from unicon.motion.importing.processed_file import ProcessedClip, ProcessedFile, load_processed
from unicon.motion.retargeting.retarget import VERSION, retarget
from unicon.motion.retargeting.skeletons import recognise
from unicon.motion.store.library import as_rows

PIPELINE_VERSION = f"1.{VERSION}"
"""Raised whenever clips come out differently, so that the next import makes them again."""

OWN_FAMILY = "unicon"
"""Family of clips that are on our humanoid already."""


class Fingerprint(NamedTuple):
    """Tells whether a file has to be processed again."""

    content: str
    """Hash of the bytes of the file and of those it depends on."""
    key: str
    """Hash of all that its clips depend on."""
    size: int
    """Number of bytes."""
    error: str = ""
    """Why it could not be read."""


UNREADABLE = Fingerprint("", "", 0, "could not be read: the process that tried was killed")


@dataclass(frozen=True)
class ImportTask:
    """A file to be processed."""

    file: MotionFile
    order: Order = field(default_factory=Order)
    """What a person wants done with this file."""
    result: Path = Path()
    """Where to leave what comes out."""
    size: int = 0
    """Number of bytes."""


def fingerprint(task: ImportTask) -> Fingerprint:
    """Return a file's fingerprint; one that cannot be read has an error instead."""
    try:
        parts = [task.file.read()]
        if task.file.suffix == ".amc":
            skeleton = task.file.sibling("*.asf")
            parts += [skeleton.read()] if skeleton else []
    except (UniconError, OSError) as error:
        return Fingerprint("", "", 0, str(error))
    content = hashlib.sha256(b"".join(parts)).hexdigest()
    about = (content, task.file.origin, PIPELINE_VERSION, hints_of(task.file.origin), task.order)
    key = hashlib.sha256(repr(about).encode()).hexdigest()
    return Fingerprint(content, key[:32], sum(len(part) for part in parts))


def process(task: ImportTask, pipeline: Callable[[ImportTask], ProcessedFile] | None = None) -> ProcessedFile:
    """Process a file and leave the result on disk, where the next run finds it after an interruption.

    Whatever is wrong with the file becomes the reason of its refusal.

    Raises:
        OSError: when the result cannot be written.
    """
    done = load_processed(task.result)
    if done is not None and not done.retry:
        return done
    started = time.process_time()
    try:
        result = (pipeline or process_file)(task)
    except UniconError as error:
        result = ProcessedFile(refused=str(error))
    except MemoryError:
        result = ProcessedFile(refused="there is not enough memory for it", retry=True)
    except Exception as error:  # one bad file must not stop thousands of good ones
        result = ProcessedFile(refused=_explain_crash(error))
    seconds = time.process_time() - started
    result = ProcessedFile(**{**vars(result), "seconds": round(seconds, 3)})
    result.save(task.result)
    return result


def process_file(task: ImportTask) -> ProcessedFile:
    """Return the clips of one file.

    Raises:
        UniconError: when it cannot be read, or nothing of it is left.
    """
    stored = _stored_clip(task.file)
    if stored is not None:
        return ProcessedFile((_to_processed(stored, task, {}, ()),), family=OWN_FAMILY)
    motion = recognise(read_motion(task.file))
    overrides = Overrides((replace(task.order, clips="*"),))
    cleaning = clean(motion, hints_of(task.file.origin), overrides)
    decisions = [str(decision) for decision in cleaning.decisions]
    clips, reasons = [], []
    for part in cleaning.parts:
        try:
            result = retarget(part)
        except UniconError as error:
            reasons.append(str(error))
            continue
        quality = {name: round(value, 4) for name, value in result.quality.to_dict().items()}
        clips.append(_to_processed(result.clip, task, quality, cleaning.marks))
    if not clips:
        reason = "; ".join(reasons or decisions) or "nothing of it is left after cleaning"
        raise UniconError(f"{task.file.origin}: {reason}")
    return ProcessedFile(tuple(clips), motion.family, tuple(decisions + reasons))


def hints_of(origin: str) -> Hints:
    """Return what names and the CMU index say of a file."""
    about, take = describe(origin), cmu_take(PurePosixPath(origin).stem)
    return Hints(
        file=origin,
        description=about.description,
        label=classify(about),
        context=about.context,
        capture_hz=take.rate_hz if take else None,
    )


def _stored_clip(file: MotionFile) -> Clip | None:
    """Return the clip of a file that ``Clip.save`` wrote; None for all others."""
    if file.suffix != ".npz" or "humanoid_id" not in list_arrays(file):
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "clip.npz"
        path.write_bytes(file.read())
        try:
            return load_clip(path)
        except UniconError as error:
            raise UniconError(str(error).replace(str(path), file.origin)) from error


def _to_processed(
    clip: Clip, task: ImportTask, quality: Mapping[str, float], marks: tuple[str, ...]
) -> ProcessedClip:
    info = ClipInfo(
        name=clip.name,
        frames=len(clip),
        label=clip.label,
        source=clip.source,
        licence=clip.licence,
        origin=task.file.origin,
        marks=marks,
        quality=quality,
    )
    return ProcessedClip(info, as_rows(clip.frames))


def _explain_crash(error: Exception) -> str:
    """Return what a mistake of the program was and where, for whoever is to mend it."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{Path(frame.filename).name}, line {frame.lineno}"
    return f"the program failed with {type(error).__name__}: {error} ({place}); please report this file"
