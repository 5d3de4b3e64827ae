"""Our reader of BVH beside bvhio and upc-pymotion: the same files, read to local rotations.

Processor time on one thread. Where the joints are is then computed from each reader's result and compared.
"""

from __future__ import annotations

from collections.abc import Sequence

import bvhio
import numpy as np
from pymotion.io.bvh import BVH
from pymotion.ops.skeleton import fk
from timing import median_core_seconds

from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.motion_file import MotionFile
from unicon.motion.retargeting.skeletons import recognise
from unicon.motion.source_motion import SourceMotion

TO_Z_UP = [2, 0, 1]
"""Which of BVH's axes (x left, y up, z forward) are ours (x forward, y left, z up)."""
POSES = 20
"""bvhio poses its skeleton frame by frame, so places are compared in this many frames of a file."""
PEERS = ("bvhio", "upc_pymotion")


def measure_readers(files: Sequence[MotionFile], turns: int) -> dict[str, float]:
    """Return frames a second of each reader, and how far our joints are from theirs at most [mm]."""
    frames = 0
    seconds: dict[str, float] = dict.fromkeys(("ours", *PEERS), 0.0)
    distances: dict[str, float] = dict.fromkeys(PEERS, 0.0)
    for file in files:
        path = str(file.path)
        works = {
            "ours": lambda file=file: read_bvh(file),
            "bvhio": lambda path=path: bvhio.readAsBvh(path),
            "upc_pymotion": lambda path=path: load_pymotion(path),
        }
        for name, value in median_core_seconds(works, turns).items():
            seconds[name] += value
        motion = read_bvh(file)
        frames += len(motion.times_s)
        found = {
            "bvhio": _distance_to_bvhio(motion, path),
            "upc_pymotion": _distance_to_pymotion(motion, path),
        }
        distances = {name: max(distances[name], found[name]) for name in PEERS}
    figures: dict[str, float] = {"files": len(files), "frames": frames}
    figures |= {f"{name}_frames_per_s": frames / value for name, value in seconds.items()}
    figures |= {f"times_{name}": seconds[name] / seconds["ours"] for name in PEERS}
    return figures | {f"largest_difference_to_{name}_mm": distances[name] for name in PEERS}


def load_pymotion(path: str) -> tuple[np.ndarray, ...]:
    """Return rotations, positions, parents and offsets of a file as upc-pymotion reads them."""
    reader = BVH()
    reader.load(path)
    return reader.get_data()


def _distance_to_pymotion(motion: SourceMotion, path: str) -> float:
    quat, pos, parents, offsets, *_ = load_pymotion(path)
    theirs, _ = fk(quat, pos[:, 0], offsets, parents)
    return _largest_mm(motion, motion.global_positions() - theirs[..., TO_Z_UP])


def _distance_to_bvhio(motion: SourceMotion, path: str) -> float:
    root = bvhio.convertBvhToHierarchy(bvhio.readAsBvh(path).Root)
    ours = motion.global_positions()
    differences = []
    for frame in np.linspace(0, len(ours) - 1, POSES).astype(int):
        root.loadPose(int(frame))
        places = {joint.Name: np.array(joint.PositionWorld)[TO_Z_UP] for joint, _, _ in root.layout()}
        differences.append(ours[frame] - np.stack([places[name] for name in motion.joint_names]))
    return _largest_mm(motion, np.stack(differences))


def _largest_mm(motion: SourceMotion, differences: np.ndarray) -> float:
    """Return the longest of vectors ``(..., 3)`` in the file's unit of length, in mm."""
    metre = np.linalg.norm(recognise(motion).offsets) / np.linalg.norm(motion.offsets)
    return float(1000 * metre * np.linalg.norm(differences, axis=-1).max())
