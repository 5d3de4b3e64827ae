"""Makes ``motions/``, the small library that the product ships, from a library of all free motions.

usage: tools/run python tools/make_default_library.py LIBRARY [FOLDER]

LIBRARY is what ``unicon motions import`` makes of the free collections. Only clips whose licence allows
it are taken; every row keeps its source and licence, and the index says from which file it was cut.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from unicon.errors import UniconError
from unicon.motion.catalogue import provenance_of
from unicon.motion.clip import RATE_HZ, Clip, clip_from_poses, repeat
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter

ROOT = Path(__file__).resolve().parents[1]


class Cut(NamedTuple):
    """One clip of the default library."""

    name: str
    clip: str
    """Name in the large library."""
    start_s: float = 0.0
    stop_s: float = 1e9
    repeats: int = 1
    """How often a cyclic clip is played."""


CUTS = (
    Cut("stand", "015_genuine", 40.0, 45.0),
    Cut("idle_shift", "012_genuine", 60.0, 68.0),
    Cut("walk", "walk", repeats=4),
    Cut("walk_slow", "cmu_deepmimic_07_05"),
    Cut("turn_left", "pybullet_walker_turn_left0", repeats=4),
    Cut("turn_right", "pybullet_walker_turn_right0", repeats=4),
    Cut("jog", "127_04"),
    Cut("run", "run", repeats=5),
    Cut("jump", "13_39"),
    Cut("wave", "Greeting"),
    Cut("punch", "punch"),
    Cut("kick", "135_07", 0.0, 5.5),
    Cut("dance", "60_15", 2.0, 10.0),
    Cut("get_up", "getup_faceup"),
)


def cut_clip(clip: Clip, cut: Cut) -> Clip:
    """Return the part of a clip that is shipped, beginning at the origin of the ground."""
    if cut.repeats > 1:
        clip = repeat(clip, cut.repeats)
    first, last = round(cut.start_s * RATE_HZ), round(cut.stop_s * RATE_HZ)
    frames = clip.frames[first : last + 1]
    root_pos = frames.root_pos_w - frames.root_pos_w[0] * [1.0, 1.0, 0.0]
    texts = {"source": clip.source, "licence": clip.licence, "label": clip.label}
    return clip_from_poses(cut.name, root_pos, frames.root_quat_w.copy(), frames.joint_pos.copy(), **texts)


def main(words: list[str]) -> int:
    """Write the library; return the exit status."""
    if not 1 <= len(words) <= 2 or "--help" in words:
        print(__doc__)
        return 0 if "--help" in words else 2
    try:
        library = ClipLibrary(Path(words[0]))
        with LibraryWriter(Path(words[1]) if len(words) == 2 else ROOT / "motions") as writer:
            for cut in CUTS:
                info = library.info(cut.clip)
                if not provenance_of(info.origin).shippable:
                    raise UniconError(f"{cut.clip} of {info.origin} may not be shipped")
                clip = cut_clip(library.get(cut.clip), cut)
                writer.add(replace(info, name=cut.name), clip.frames)
                print(f"{cut.name:12s} {clip.duration_s:4.1f} s  {info.origin}")
            writer.commit()
    except UniconError as error:
        print(f"make_default_library: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
