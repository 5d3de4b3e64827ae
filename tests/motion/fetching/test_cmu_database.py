"""Tests for cmu_database.py, against a small copy of the site."""

from __future__ import annotations

import subprocess
from io import StringIO

import pytest
from rich.console import Console

from tests.motion.fetching.test_download import IMPATIENT, site  # noqa: F401 - a fixture
from unicon.errors import UniconError, UnknownNameError
from unicon.motion.fetching.cmu_database import CmuConfig, Fetched, fetch_cmu, file_names, read_sums

SUBJECT = 45
"""A subject with one take."""
ASF, AMC = "subjects/45/45.asf", "subjects/45/45_01.amc"


@pytest.fixture
def copy(site):  # noqa: F811
    site.files = {f"/{ASF}": b":version 1.10\n" * 40, f"/{AMC}": b":FULLY-SPECIFIED\n" * 900}
    return site


def fetch(copy, tmp_path, subjects=(SUBJECT,)) -> Fetched:
    config = CmuConfig(subjects, tmp_path / "cmu", copy.url)
    return fetch_cmu(config, Console(file=StringIO()), IMPATIENT)


def test_skeletons_come_before_their_takes():
    assert file_names((SUBJECT, 24)) == ["subjects/24/24.asf", "subjects/24/24_01.amc", ASF, AMC]
    assert len(file_names()) > 2000


def test_an_unknown_subject_is_answered_with_the_nearest():
    with pytest.raises(UnknownNameError, match="no subject 999 .* nearest are .*144"):
        file_names((1, 999))


def test_files_arrive_with_their_checksums_and_the_credit_line(copy, tmp_path):
    done = fetch(copy, tmp_path)
    assert (done.new, done.kept, done.missing) == (2, 0, ())
    assert (tmp_path / "cmu" / AMC).read_bytes() == copy.files[f"/{AMC}"]
    check = subprocess.run(
        ["sha256sum", "--check", "SHA256SUMS"], cwd=done.folder, capture_output=True, check=False
    )
    assert check.returncode == 0, check.stderr
    assert "NSF EIA-0196217" in (done.folder / "README.txt").read_text()
    assert not list(done.folder.rglob("*.part"))


def test_what_is_there_is_not_asked_for_again(copy, tmp_path):
    fetch(copy, tmp_path)
    copy.requests.clear()
    done = fetch(copy, tmp_path)
    assert (done.new, done.kept) == (0, 2)
    assert copy.requests == []


def test_a_damaged_file_is_fetched_again(copy, tmp_path):
    folder = fetch(copy, tmp_path).folder
    (folder / AMC).write_bytes(b"damaged")
    done = fetch(copy, tmp_path)
    assert (done.new, done.kept) == (1, 1)
    assert (folder / AMC).read_bytes() == copy.files[f"/{AMC}"]


def test_a_file_that_changed_on_the_server_is_said_and_not_used(copy, tmp_path):
    folder = fetch(copy, tmp_path).folder
    (folder / AMC).unlink()
    copy.files[f"/{AMC}"] = b"another"
    with pytest.raises(UniconError, match="1 files .* another sha256 .*45_01.amc.*SHA256SUMS"):
        fetch(copy, tmp_path)
    assert not (folder / AMC).exists()
    sums = folder / "SHA256SUMS"
    sums.write_text("".join(line for line in sums.open() if AMC not in line))
    assert fetch(copy, tmp_path).new == 1
    assert (folder / AMC).read_bytes() == b"another"


def test_an_interrupted_call_is_gone_on_with(copy, tmp_path):
    copy.cuts = [len(copy.files[f"/{ASF}"]), 5000] + [0] * 9
    with pytest.raises(UniconError, match="45_01.amc: could not be fetched"):
        fetch(copy, tmp_path)
    copy.cuts.clear()
    copy.requests.clear()
    done = fetch(copy, tmp_path)
    assert (done.new, done.kept) == (1, 1)
    assert copy.requests == [(f"/{AMC}", "bytes=5000-")]


def test_a_line_cut_short_in_the_checksums_costs_one_file(copy, tmp_path):
    folder = fetch(copy, tmp_path).folder
    sums = folder / "SHA256SUMS"
    sums.write_text(sums.read_text()[:-30])
    assert fetch(copy, tmp_path).kept == 1
    assert set(read_sums(sums)) == {ASF, AMC}


def test_takes_that_the_server_lacks_are_listed_and_the_others_fetched(copy, tmp_path):
    del copy.files[f"/{AMC}"]
    done = fetch(copy, tmp_path)
    assert (done.new, done.missing) == (1, (AMC,))


def test_a_wrong_server_is_left_after_a_few_files(copy, tmp_path):
    copy.files.clear()
    with pytest.raises(UniconError, match="has none of the first 5 files"):
        fetch(copy, tmp_path, subjects=())
    assert len(copy.requests) == 5


def test_only_web_addresses_are_taken(tmp_path):
    with pytest.raises(UniconError, match="expected one that begins with http"):
        fetch_cmu(CmuConfig((1,), tmp_path, "file:///etc"), Console(file=StringIO()), IMPATIENT)
