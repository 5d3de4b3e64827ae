"""Downloads one file over HTTP so that nothing that arrived is fetched twice.

The file grows beside its place as ``NAME.part``. After an interruption the rest is asked for with a
``Range``, and with ``If-Range`` the server sends all of it when its file is another by then: the part
carries the date that the server gave its file.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from email.utils import formatdate, parsedate_to_datetime
from http.client import HTTPException, HTTPResponse
from pathlib import Path
from typing import NamedTuple
from urllib.error import HTTPError, URLError
from urllib.request import Request, urlopen

from unicon.errors import UniconError

CHUNK = 65536
GONE = (403, 404, 410)
NETWORK_ERRORS = (URLError, HTTPException, ConnectionError, TimeoutError)


class NotOnServerError(UniconError):
    """The server does not have the file, or does not give it."""


@dataclass(frozen=True)
class DownloadConfig:
    """How patient a download is."""

    timeout_s: float = 30.0
    """Longest silence of the server."""
    attempts: int = 5
    """Attempts one after the other that bring nothing before it gives up."""
    pause_s: float = 1.0
    """Pause after the first of them; each later one is twice as long."""
    longest_pause_s: float = 60.0


class _Rest(NamedTuple):
    """What the server is about to send."""

    first: int
    """Number of the first byte."""
    total: int | None
    """Length of the whole file, where the server says it."""


class _IncompleteError(Exception):
    """An attempt that left something to do, with its reason."""


def download(
    url: str,
    path: Path,
    config: DownloadConfig = DownloadConfig(),  # noqa: B008 - frozen
    tell: Callable[[int], None] = lambda count: None,
) -> Path:
    """Download a file and return where it is: ``path`` with .part at the end, for the caller to check.

    ``tell`` is called with the number of bytes that just arrived.

    Raises:
        NotOnServerError: when the server does not have it.
        UniconError: when the server does not answer or the disk is full; what arrived is kept.
    """
    part = path.with_name(f"{path.name}.part")
    failures = 0
    while True:
        before = _size(part)
        try:
            _take_rest(url, part, config, tell)
            return part
        except HTTPError as error:
            reason, least_s = f"{error.code} {error.reason}", _retry_after_s(error)
            if error.code in GONE:
                raise NotOnServerError(f"{url}: the server does not have it ({reason})") from error
        except (*NETWORK_ERRORS, _IncompleteError) as error:
            reason, least_s = str(getattr(error, "reason", error)) or type(error).__name__, 0.0
        failures = 1 if _size(part) > before else failures + 1
        if failures >= config.attempts:
            raise UniconError(
                f"{url}: could not be fetched in {failures} attempts ({reason}); look at the network and "
                "call again, what was fetched is kept"
            )
        pause_s = max(config.pause_s * 2.0 ** (failures - 1), least_s)
        time.sleep(min(pause_s, config.longest_pause_s))


def _size(part: Path) -> int:
    return part.stat().st_size if part.exists() else 0


def _take_rest(url: str, part: Path, config: DownloadConfig, tell: Callable[[int], None]) -> None:
    """Append what is missing to the part, from one answer of the server."""
    have = _size(part)
    request = Request(url, headers={"User-Agent": "unicon", "Accept-Encoding": "identity"})
    if have:
        request.add_header("Range", f"bytes={have}-")
        request.add_header("If-Range", formatdate(part.stat().st_mtime, usegmt=True))
    try:
        response = urlopen(request, timeout=config.timeout_s)
    except HTTPError as error:
        if error.code != 416:
            raise
        if error.headers.get("Content-Range", "") == f"bytes */{have}":
            return
        part.unlink()
        raise _IncompleteError("what was there does not fit the server's file") from error
    with response:
        rest = _rest_of(response, have)
        try:
            _append(response, part, rest, tell)
        finally:
            _keep_date(part, response)
    if rest.total is not None and _size(part) != rest.total:
        raise _IncompleteError(f"the connection ended at {_size(part)} of {rest.total} bytes")


def _rest_of(response: HTTPResponse, have: int) -> _Rest:
    if response.status != 206:
        length = response.headers.get("Content-Length")
        return _Rest(0, int(length) if length else None)
    places, _, total = response.headers.get("Content-Range", "").removeprefix("bytes ").partition("/")
    if places.split("-")[0] != str(have):
        raise _IncompleteError(f"the server sent the bytes {places}, asked for those from {have}")
    return _Rest(have, int(total) if total.isdigit() else None)


def _append(response: HTTPResponse, part: Path, rest: _Rest, tell: Callable[[int], None]) -> None:
    try:
        file = part.open("ab" if rest.first else "wb", buffering=0)
    except OSError as error:
        raise _disk_error(part, error) from error
    with file:
        while chunk := response.read(CHUNK):
            try:
                file.write(chunk)
            except OSError as error:
                raise _disk_error(part, error) from error
            tell(len(chunk))


def _disk_error(part: Path, error: OSError) -> UniconError:
    return UniconError(
        f"{part}: cannot be written ({error.strerror or error}); make room or choose another folder, then "
        "call again, what was fetched is kept"
    )


def _keep_date(part: Path, response: HTTPResponse) -> None:
    """Give the part the date of the server's file."""
    with suppress(TypeError, ValueError, OSError):
        date_s = int(parsedate_to_datetime(response.headers["Last-Modified"]).timestamp())
        os.utime(part, (date_s, date_s))


def _retry_after_s(error: HTTPError) -> float:
    text = error.headers.get("Retry-After", "")
    return float(text) if text.isdigit() else 0.0
