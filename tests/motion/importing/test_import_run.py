"""Tests for import_run.py, with a quick pipeline: each file's text says what clips it gives."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import signal
import zipfile
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from tests.samples import swaying_clip
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import ClipInfo
from unicon.motion.importing import import_run as module
from unicon.motion.importing.file_processing import ImportTask
from unicon.motion.importing.import_config import ImportConfig
from unicon.motion.importing.import_report import FileRecord, read_report
from unicon.motion.importing.import_run import ImportOutcome, run_import
from unicon.motion.importing.processed_file import ProcessedClip, ProcessedFile, load_processed
from unicon.motion.store.library import ClipLibrary, as_rows


def quick(task: ImportTask) -> ProcessedFile:
    """Make a swaying clip of as many frames as the file's text says; other words go wrong in their way."""
    text = task.file.read().decode()
    if text == "bad":
        raise UniconError(f"{task.file.origin}, line 1: is no motion")
    if text == "crash":
        raise ZeroDivisionError("division by zero")
    if text == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if text == "stop" and not (Path(task.result).parent / "stopped").exists():
        (Path(task.result).parent / "stopped").touch()
        raise KeyboardInterrupt
    frames = swaying_clip(int(text[:2]) if text.isdigit() else 30).frames
    info = ClipInfo(task.file.name, 0, "", quality={"mean_error_mm": 12.0})
    return ProcessedFile((ProcessedClip(info, as_rows(frames)),), "made_up", ("cut frames 0-1 (test): so",))


class Place:
    """A folder with sources, and the library made of them."""

    def __init__(self, folder: Path) -> None:
        self.sources = folder / "sources"
        self.sources.mkdir()
        self.out = folder / "library"
        self.said = StringIO()

    def write(self, **texts: str) -> None:
        for name, text in texts.items():
            (self.sources / f"{name}.bvh").write_text(text)

    def run(self, *paths: Path, **options: object) -> ImportOutcome:
        config = ImportConfig(paths or (self.sources,), **{"out": self.out, "jobs": 1, **options})
        return run_import(config, Console(file=self.said, width=200), quick)

    @property
    def library(self) -> ClipLibrary:
        return ClipLibrary(self.out)

    def record(self, name: str) -> FileRecord:
        records = read_report(self.out).files
        return next(record for record in records if record.origin.endswith(f"/{name}.bvh"))

    def files(self) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in self.out.iterdir() if path.is_file()}


@pytest.fixture
def place(tmp_path: Path) -> Place:
    return Place(tmp_path)


def test_files_become_clips_with_class_and_report(place):
    place.write(walk_slowly="40", jump="50", broken="bad")
    outcome = place.run()
    assert place.library.names == ["jump", "walk_slowly"]
    info = place.library.info("walk_slowly")
    assert (info.frames, info.label.split("/")[0]) == (40, "walking")
    assert info.origin == str(place.sources / "walk_slowly.bvh")
    assert info.quality == {"mean_error_mm": 12.0}
    assert [record.origin for record in outcome.report.refused] == [str(place.sources / "broken.bvh")]
    text = (place.out / "import_report.md").read_text()
    assert "broken.bvh, line 1: is no motion" in text
    assert "jump.bvh: cut frames 0-1 (test): so" in text
    assert "| made_up | 2 |" in text
    assert "2 clips" in str(outcome)


def test_one_bad_file_does_not_stop_the_rest(place):
    place.write(a="bad", b="crash", c="30", d="31")
    place.run()
    assert place.library.names == ["c", "d"]
    assert "ZeroDivisionError: division by zero (test_import_run.py, line" in place.record("b").refused


def test_a_process_that_is_killed_is_reported_and_tried_again_next_time(place):
    place.write(a="kill", b="30", c="31")
    place.run(jobs=2)
    assert place.library.names == ["b", "c"]
    assert "killed" in place.record("a").refused
    place.write(a="32")
    assert place.run().run.made == 1
    assert place.library.names == ["a", "b", "c"]


def test_a_second_import_does_nothing(place):
    place.write(walk="40", broken="bad")
    place.run()
    before = place.files()
    outcome = place.run()
    assert (outcome.run.made, outcome.run.unchanged, outcome.changed) == (0, 2, False)
    assert "nothing new" in str(outcome)
    assert place.files() == before


def test_only_what_changed_is_made_again(place):
    place.write(walk="40", run="30", jump="20")
    place.run()
    place.write(run="35", turn="25")
    outcome = place.run()
    assert (outcome.run.made, outcome.run.unchanged) == (2, 2)
    assert {info.name: info.frames for info in place.library.infos} == {
        "jump": 20,
        "run": 35,
        "turn": 25,
        "walk": 40,
    }
    assert place.run(again=True).run.made == 4


def test_an_import_in_steps_gives_the_same_library_as_one_at_once(tmp_path):
    steps, once = (
        Place(tmp_path),
        Place(tmp_path / "once" if (tmp_path / "once").mkdir() is None else tmp_path),
    )
    steps.write(walk="40")
    steps.run()
    steps.write(run="30")
    steps.run()
    once.run(steps.sources)
    for name, data in once.files().items():
        assert name.startswith("import_report") or steps.files()[name] == data


def test_the_library_is_the_same_whatever_the_number_of_processes(place, tmp_path):
    place.write(**{f"walk_{k}": str(20 + k) for k in range(8)}, broken="bad")
    place.run(jobs=1, mirror=True)
    serial = place.files()
    place.out = tmp_path / "parallel"
    place.run(jobs=2, mirror=True)
    for name, data in place.files().items():
        assert name.startswith("import_report") or serial[name] == data


def test_an_interrupted_import_goes_on_where_it_was(place):
    place.write(longest="40000", b="stop", c="30")
    with pytest.raises(KeyboardInterrupt):
        place.run()
    assert "stopped; 1 of 3 files are done and kept: the same command goes on" in place.said.getvalue()
    assert not (place.out / "index.json").exists()
    (kept,) = (place.out / ".import").glob("*.npz")
    done = load_processed(kept)
    ProcessedFile(**{**vars(done), "family": "kept"}).save(kept)
    place.run()
    assert place.library.names == ["b", "c", "longest"]
    assert (place.record("longest").family, place.record("c").family) == ("kept", "made_up")
    assert not (place.out / ".import").exists()


def test_an_interrupted_import_leaves_the_old_library(place):
    place.write(a="40")
    place.run()
    place.write(b="stop")
    with pytest.raises(KeyboardInterrupt):
        place.run()
    assert place.library.names == ["a"]


def test_the_same_bytes_are_added_once(place):
    place.write(walk="40")
    (place.sources / "copy").mkdir()
    (place.sources / "copy" / "walk_again.bvh").write_text("40")
    outcome = place.run()
    assert len(place.library) == 1
    assert place.record("walk").duplicate_of.endswith("copy/walk_again.bvh")
    assert "1 are there twice" in str(outcome)
    assert place.run().run.made == 0


def test_the_same_name_in_two_folders_becomes_two_clips(place):
    place.write(walk="40")
    (place.sources / "other").mkdir()
    (place.sources / "other" / "walk.bvh").write_text("50")
    place.run()
    assert {info.name: info.frames for info in place.library.infos} == {"walk": 50, "sources_walk": 40}


def test_files_of_archives_with_the_same_name_are_told_apart(place):
    for folder, text in (("one", "40"), ("two", "50")):
        (place.sources / folder).mkdir()
        with zipfile.ZipFile(place.sources / folder / "takes.zip", "w") as archive:
            archive.writestr("walk.bvh", text)
    place.run()
    assert sorted(place.library.lengths) == [40, 50]
    assert place.run().run.made == 0


def test_clips_whose_files_are_gone_stay_unless_asked(place):
    place.write(walk="40", run="30")
    place.run()
    (place.sources / "run.bvh").unlink()
    assert not place.run().changed
    assert place.library.names == ["run", "walk"]
    assert place.run(prune=True).changed
    assert place.library.names == ["walk"]


def test_a_file_that_went_bad_takes_its_clips_along(place):
    place.write(walk="40", run="30")
    place.run()
    place.write(run="bad")
    place.run()
    assert place.library.names == ["walk"]


def test_mirrored_copies_share_the_take_and_the_side_of_the_split(place):
    place.write(walk="40", run="30", jump="20")
    place.run(mirror=True)
    library = place.library
    assert len(library) == 6
    for name in ("walk", "run", "jump"):
        one, two = library.info(name), library.info(f"{name}_mirrored")
        assert (one.take, one.split, one.label) == (two.take, two.split, two.label)
    mirrored = HUMANOID.mirror(library.get("walk").frames)
    assert np.allclose(library.get("walk_mirrored").frames.joint_pos, mirrored.joint_pos, atol=1e-6)
    assert not place.run(mirror=True).changed
    place.run()
    assert len(place.library) == 3


def test_the_split_is_in_the_index_and_in_a_file(place):
    place.write(**{f"walk_{k}": str(20 + k) for k in range(10)})
    place.run()
    sides = {info.name: info.split for info in place.library.infos}
    assert set(sides.values()) == {"train", "test"}
    assert all(f"{name}: {side}" in (place.out / "split.yaml").read_text() for name, side in sides.items())


def test_source_and_licence_are_what_a_person_says_and_stay_so(place):
    place.write(walk="40")
    place.run(licence="CC0", source="our studio")
    place.run()
    info = place.library.info("walk")
    assert (info.source, info.licence) == ("our studio", "CC0")


def test_a_lost_report_costs_work_but_no_clips(place):
    place.write(walk="40")
    place.run()
    (place.out / "import_report.json").write_text("{")
    place.run(place.sources / "walk.bvh")
    assert place.library.names == ["walk"]


def test_no_motions_is_said_in_one_sentence(place):
    with pytest.raises(UniconError, match=r"sources: no motions found; expected .*\.bvh"):
        place.run()
    with pytest.raises(UniconError, match="nothing to import"):
        run_import(ImportConfig((), place.out), Console(file=place.said))


def test_when_no_file_can_be_used_one_reason_is_given(place):
    place.write(a="bad")
    with pytest.raises(UniconError, match=r"none of the 1 files .*is no motion.*import_report.md"):
        place.run()
    assert json.loads((place.out / "import_report.json").read_text())["files"][0]["refused"]
    place.write(a="40")
    assert place.run().changed


def test_a_folder_of_other_things_is_not_written_to(place):
    place.write(walk="40", run="30")
    for out in (place.sources, place.sources / "walk.bvh"):
        with pytest.raises(UniconError, match="not empty and not a clip library"):
            place.run(place.sources / "run.bvh", out=out)


def test_two_imports_into_one_library_do_not_mix(place):
    place.write(walk="40")
    (place.out / ".import").mkdir(parents=True)
    with (place.out / ".import" / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(UniconError, match="another import is at work"):
            place.run()


def test_a_full_disk_is_said_in_one_sentence(place, monkeypatch):
    def fill(*arguments: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    place.write(walk="40")
    monkeypatch.setattr(ProcessedFile, "save", fill)
    with pytest.raises(
        UniconError, match=r"library: cannot be written \(No space left on device\); make room"
    ):
        place.run()


def test_a_place_that_cannot_be_written_is_named(place):
    place.write(walk="40")
    with pytest.raises(UniconError, match="cannot be written"):
        place.run(out=Path("/proc/library"))


def test_the_library_itself_is_not_a_source_of_motions(place):
    place.write(walk="40")
    place.out = place.sources / "library"
    place.run()
    assert module.WORK_FOLDER.startswith(".")
    assert place.run().run.unchanged == 1
