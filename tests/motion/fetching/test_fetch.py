"""Tests for fetch.py: with a wheel made here, since the real one is a hundred megabytes."""

from __future__ import annotations

import hashlib
import json
import subprocess
import zipfile
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from tests.motion.formats.test_deepmimic import row
from unicon.errors import UniconError
from unicon.motion.fetching import fetch as module


@pytest.fixture
def console() -> Console:
    return Console(file=StringIO())


@pytest.fixture
def fake_registry(monkeypatch, tmp_path):
    """pip download leaves a small wheel with two motions."""
    frames = [row(1 / 30, x=0.04 * k, knee=-0.4) for k in range(30)]
    content = json.dumps({"Loop": "wrap", "Frames": frames}).encode()
    files = {"humanoid3d_walk.txt": content, "humanoid3d_kick.txt": content}
    monkeypatch.setenv("UNICON_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(module, "FILES", {n: hashlib.sha256(c).hexdigest() for n, c in files.items()})

    def download(command, **options):
        folder = Path(command[command.index("--dest") + 1])
        with zipfile.ZipFile(folder / "pybullet-3.2.7.whl", "w") as wheel:
            for name, data in files.items():
                wheel.writestr(module.FOLDER_IN_WHEEL + name, data)
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(module.subprocess, "run", download)
    return files


def test_motions_are_fetched_once_and_then_there(fake_registry, console, monkeypatch):
    library = module.fetch(console)
    assert library.names == ["kick", "walk"]
    assert library.get("walk").licence == "zlib"
    assert library.get("walk").duration_s > 3.5
    assert library.info("walk").label.split("/")[0] == "walking"
    assert library.info("walk").quality["mean_error_mm"] < 40.0
    assert "zlib" in console.file.getvalue()
    monkeypatch.setattr(module.subprocess, "run", None)
    assert module.fetch(console).names == ["kick", "walk"]


def test_nothing_but_the_clips_is_kept(fake_registry, console, tmp_path):
    module.fetch(console)
    kept = sorted(path.name for path in (tmp_path / "cache").rglob("*") if path.is_file())
    assert [kept[0], kept[2]] == ["about.json", "index.json"]
    assert kept[1].startswith("frames-") and len(kept) == 3


def test_a_file_that_was_changed_is_not_used(fake_registry, console, monkeypatch):
    monkeypatch.setattr(module, "FILES", {"humanoid3d_walk.txt": "0" * 64})
    with pytest.raises(UniconError, match="humanoid3d_walk.txt has the sha256"):
        module.fetch(console)
    assert not module.fetched_folder().exists()


def test_without_a_network_it_says_what_to_do(fake_registry, console, monkeypatch):
    def fail(command, **options):
        return subprocess.CompletedProcess(command, 1, "", "ERROR: No matching distribution")

    monkeypatch.setattr(module.subprocess, "run", fail)
    with pytest.raises(UniconError, match="look at the network"):
        module.fetch(console)


def test_a_full_disk_is_said_in_one_sentence(fake_registry, console, monkeypatch):
    def fill(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(module, "_make_clips", fill)
    with pytest.raises(UniconError, match="No space left on device"):
        module.fetch(console)
