"""Compiles the kernel, once for each version of its sources, the humanoid and the processor.

``python -m unicon.train.environment.batch_simulator.build`` does it ahead of time; otherwise the first
simulator does. The library lies in the user's cache under a hash of everything that it depends on.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from unicon.cache import cache_folder
from unicon.errors import UniconError
from unicon.train.environment.batch_simulator.tables import write_header

SOURCES = Path(__file__).parent
FLAGS = (
    *("-std=c++17", "-O3", "-march=native", "-shared", "-fPIC", "-pthread"),
    *("-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros"),
    *("-Wall", "-Wextra", "-Wno-psabi"),
)
"""No -ffast-math: not-a-number has to stay recognisable."""

COMPILERS = ("g++", "c++")


class NoCompilerError(UniconError):
    """This machine cannot compile the kernel; the ``mujoco`` simulator does the same, slowly."""


def build_kernel(flags: tuple[str, ...] = FLAGS) -> Path:
    """Return the kernel compiled with ``flags``, after compiling it if need be.

    Raises:
        NoCompilerError: when there is no compiler, or it fails.
    """
    header = write_header()
    compiler = find_compiler()
    folder = cache_folder() / "batch_simulator" / build_key(compiler, header, flags)
    library = folder / "kernel.so"
    if library.is_file():
        return library
    folder.mkdir(parents=True, exist_ok=True)
    with _locked(folder / "lock"):
        if not library.is_file():
            (folder / "humanoid.hpp").write_text(header)
            _compile(compiler, flags, folder, library)
    return library


def find_compiler() -> str:
    """Return the C++ compiler: $CXX, g++ or c++.

    Raises:
        NoCompilerError: when there is none.
    """
    wanted = [os.environ["CXX"]] if os.environ.get("CXX") else list(COMPILERS)
    found = next((path for name in wanted if (path := shutil.which(name))), None)
    if found is None:
        names = " or ".join(wanted)
        raise NoCompilerError(
            f"the batch simulator needs a C++ compiler, and there is no {names}; install one with "
            "`sudo apt install g++`, or use the mujoco simulator"
        )
    return found


def build_key(compiler: str, header: str, flags: tuple[str, ...] = FLAGS) -> str:
    """Return a hash of the sources, the humanoid's constants, the flags, the compiler and the processor."""
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False).stdout
    digest = hashlib.sha256()
    for part in (header, *flags, version, processor()):
        digest.update(part.encode() + b"\0")
    for path in source_files():
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def source_files() -> list[Path]:
    """Return the C++ files of this folder."""
    return sorted([*SOURCES.glob("*.cpp"), *SOURCES.glob("*.hpp")])


def processor(cpuinfo: Path = Path("/proc/cpuinfo")) -> str:
    """Return what tells processors apart for which the compiler makes different code."""
    lines = cpuinfo.read_text().splitlines() if cpuinfo.is_file() else []
    flags = next((line for line in lines if line.startswith(("flags", "Features"))), "")
    return f"{platform.machine()} {flags}"


def _compile(compiler: str, flags: tuple[str, ...], folder: Path, library: Path) -> None:
    """Compile to a file of another name first, so that the library is whole or not there."""
    with tempfile.TemporaryDirectory(dir=folder) as scratch:
        made = Path(scratch) / library.name
        source = str(SOURCES / "kernel.cpp")
        command = [compiler, *flags, f"-I{folder}", source, "-o", str(made)]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            log = folder / "compile.log"
            log.write_text(result.stdout + result.stderr)
            raise NoCompilerError(
                f"{compiler} could not compile the batch simulator; what it said is in {log}, and the "
                "mujoco simulator works without it"
            )
        made.replace(library)


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Let one process at a time in."""
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def main() -> int:
    """Build, and say where; return the exit status."""
    start = time.monotonic()
    try:
        library = build_kernel()
    except UniconError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{library} ({time.monotonic() - start:.1f} s)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
