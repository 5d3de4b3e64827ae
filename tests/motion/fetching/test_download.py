"""Tests for download.py, against a server in this process that does what the test tells it to."""

from __future__ import annotations

import errno
import os
import socket
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

import pytest

from unicon.errors import UniconError
from unicon.motion.fetching.download import DownloadConfig, NotOnServerError, download

IMPATIENT = DownloadConfig(timeout_s=5.0, attempts=3, pause_s=0.0)
DATE = "Wed, 12 Mar 2008 09:30:00 GMT"


class Site:
    """Files by path, what is asked for them, and how the server misbehaves."""

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.date = DATE
        self.requests: list[tuple[str, str | None]] = []
        self.cuts: list[int] = []
        """After how many bytes each of the coming answers is cut."""
        self.statuses: list[int] = []
        """What the coming answers are instead."""
        self.url = ""


class Handler(BaseHTTPRequestHandler):
    site: Site

    def do_GET(self) -> None:  # noqa: N802 - the base class names it
        site, span = self.site, self.headers.get("Range")
        site.requests.append((self.path, span))
        if site.statuses:
            return self.answer(site.statuses.pop(0), b"", {})
        if self.path not in site.files:
            return self.answer(404, b"", {})
        data, first = site.files[self.path], 0
        if span and self.headers["If-Range"] == site.date:
            first = int(span.removeprefix("bytes=").rstrip("-"))
            if first >= len(data):
                return self.answer(416, b"", {"Content-Range": f"bytes */{len(data)}"})
        places = {"Content-Range": f"bytes {first}-{len(data) - 1}/{len(data)}"} if first else {}
        return self.answer(206 if first else 200, data[first:], places)

    def answer(self, status: int, data: bytes, headers: dict[str, str]) -> None:
        self.send_response(status)
        sent = {"Content-Length": str(len(data)), "Last-Modified": self.site.date, **headers}
        for name, value in sent.items():
            self.send_header(name, value)
        self.end_headers()
        cut = self.site.cuts.pop(0) if data and self.site.cuts else len(data)
        self.wfile.write(data[:cut])

    def log_message(self, *arguments: object) -> None:
        pass


@pytest.fixture
def site(monkeypatch) -> Iterator[Site]:
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    content = Site()
    handler = type("SiteHandler", (Handler,), {"site": content})
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        content.url = f"http://127.0.0.1:{server.server_port}"
        thread = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield content
        server.shutdown()
        thread.join()


def test_a_file_arrives_whole_beside_its_place(site, tmp_path):
    site.files["/a.amc"] = bytes(range(256)) * 1000
    arrived = []
    part = download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT, arrived.append)
    assert part == tmp_path / "a.amc.part"
    assert part.read_bytes() == site.files["/a.amc"]
    assert sum(arrived) == 256_000
    assert site.requests == [("/a.amc", None)]


def test_what_a_cut_left_is_not_fetched_again(site, tmp_path):
    site.files["/a.amc"] = bytes(range(250)) * 4
    site.cuts = [300, 200]
    part = download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    assert part.read_bytes() == site.files["/a.amc"]
    assert [span for _, span in site.requests] == [None, "bytes=300-", "bytes=500-"]


def test_a_part_of_another_version_of_the_file_is_replaced(site, tmp_path):
    site.files["/a.amc"] = b"old" * 100
    site.cuts = [150] + [0] * 9
    with pytest.raises(UniconError, match="the connection ended at 150 of 300 bytes"):
        download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    site.cuts, site.date = [], "Thu, 13 Mar 2008 09:30:00 GMT"
    site.files["/a.amc"] = b"new" * 100
    part = download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    assert part.read_bytes() == b"new" * 100
    assert site.requests[-1][1] == "bytes=150-"


def test_a_part_that_is_whole_is_not_fetched_again(site, tmp_path):
    site.files["/a.amc"] = b"x" * 100
    download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    again = download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    assert again.read_bytes() == b"x" * 100
    assert site.requests[-1] == ("/a.amc", "bytes=100-")


def test_a_part_longer_than_the_file_is_begun_anew(site, tmp_path):
    site.files["/a.amc"] = b"x" * 100
    part = download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    date_s = part.stat().st_mtime
    part.write_bytes(b"y" * 120)
    os.utime(part, (date_s, date_s))
    assert download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT).read_bytes() == b"x" * 100


def test_a_busy_server_is_asked_again(site, tmp_path):
    site.files["/a.amc"] = b"x"
    site.statuses = [503, 500]
    assert download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT).read_bytes() == b"x"
    assert len(site.requests) == 3


def test_a_file_that_the_server_lacks_is_asked_for_once(site, tmp_path):
    with pytest.raises(NotOnServerError, match="b.amc: the server does not have it \\(404"):
        download(f"{site.url}/b.amc", tmp_path / "b.amc", IMPATIENT)
    assert len(site.requests) == 1


def test_a_refused_connection_ends_with_one_sentence(tmp_path, monkeypatch):
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{closed.getsockname()[1]}/a.amc"
        with pytest.raises(UniconError, match="in 3 attempts .*refused.*look at the network"):
            download(url, tmp_path / "a.amc", IMPATIENT)


def test_each_attempt_in_vain_waits_twice_as_long(site, tmp_path, monkeypatch):
    pauses = []
    monkeypatch.setattr("unicon.motion.fetching.download.time.sleep", pauses.append)
    site.files["/a.amc"] = b"x"
    site.statuses = [500, 500, 500]
    download(f"{site.url}/a.amc", tmp_path / "a.amc", DownloadConfig(attempts=4, longest_pause_s=3.0))
    assert pauses == [1.0, 2.0, 3.0]


def test_a_full_disk_keeps_what_arrived(site, tmp_path, monkeypatch):
    site.files["/a.amc"] = b"x" * 200_000
    (tmp_path / "a.amc.part").write_bytes(b"")
    real_open = type(tmp_path).open

    class FullDisk:
        def __init__(self, file: object) -> None:
            self.file, self.room = file, 100_000

        def __enter__(self) -> FullDisk:
            return self

        def __exit__(self, *error: object) -> None:
            self.file.close()

        def write(self, data: bytes) -> int:
            if len(data) > self.room:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            self.room -= len(data)
            return self.file.write(data)

    monkeypatch.setattr(type(tmp_path), "open", lambda path, *a, **k: FullDisk(real_open(path, *a, **k)))
    with pytest.raises(UniconError, match="a.amc.part: cannot be written \\(No space left on device\\)"):
        download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT)
    monkeypatch.undo()
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    assert 0 < (tmp_path / "a.amc.part").stat().st_size <= 100_000
    assert len(download(f"{site.url}/a.amc", tmp_path / "a.amc", IMPATIENT).read_bytes()) == 200_000
    assert site.requests[-1][1] is not None
