"""A clip: a motion on our humanoid at 60 Hz, with where it came from and what may be done with it."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from unicon import rotations
from unicon.errors import InputFileError
from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import RATE_HZ
from unicon.state import CharacterState, differentiate, move

_TEXTS = ("name", "source", "licence", "label")


@dataclass(frozen=True)
class Clip:
    """A motion; its arrays cannot be written to."""

    name: str
    frames: CharacterState
    """Batch ``(T,)``, T >= 2, at 60 Hz."""
    source: str = ""
    """Where it was captured or made."""
    licence: str = ""
    label: str = ""
    """Its class, e.g. walk."""

    def __post_init__(self) -> None:
        for field in fields(CharacterState):
            getattr(self.frames, field.name).flags.writeable = False

    def __len__(self) -> int:
        return self.frames.batch_shape[0]

    @property
    def duration_s(self) -> float:
        """Time from the first frame to the last."""
        return (len(self) - 1) / RATE_HZ

    def save(self, path: Path) -> None:
        """Write the poses; velocities follow from them."""
        texts = {name: np.array(getattr(self, name)) for name in _TEXTS}
        np.savez_compressed(
            path,
            humanoid_id=np.array(HUMANOID.id),
            root_pos_w=self.frames.root_pos_w,
            root_quat_w=self.frames.root_quat_w,
            joint_pos=self.frames.joint_pos,
            **texts,  # pyright: ignore[reportArgumentType] - its stub takes them for allow_pickle
        )


def clip_from_poses(
    name: str,
    root_pos_w: np.ndarray,
    root_quat_w: np.ndarray,
    joint_pos: np.ndarray,
    **texts: str,
) -> Clip:
    """Return a clip of poses ``(T, 3)``, ``(T, 4)``, ``(T, 35)``, with velocities by differences."""
    frames = differentiate(root_pos_w, continuous_signs(root_quat_w), joint_pos, RATE_HZ)
    return Clip(name, frames, **texts)


def continuous_signs(quat: np.ndarray) -> np.ndarray:
    """Return the same rotations ``(T, 4)`` with signs that never jump from one to the next."""
    flips = np.sum(quat[1:] * quat[:-1], axis=-1) < 0.0
    signs = np.concatenate([[1.0], np.where(flips, -1.0, 1.0)]).cumprod()
    return quat * signs[:, None]


def load_clip(path: Path) -> Clip:
    """Read a clip.

    Raises:
        InputFileError: when it cannot be read, or was made for another humanoid.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            data = {name: file[name] for name in file.files}
    except (OSError, ValueError, zipfile.BadZipFile, EOFError) as error:
        raise InputFileError(f"{path}: is not a clip ({error}); make it again from its source") from error
    expected = {"humanoid_id", "root_pos_w", "root_quat_w", "joint_pos", *_TEXTS}
    missing = expected - set(data)
    if missing:
        raise InputFileError(f"{path}: is not a clip, since it lacks {sorted(missing)[0]!r}")
    if str(data["humanoid_id"]) != HUMANOID.id:
        made_for = str(data["humanoid_id"])
        raise InputFileError(
            f"{path}: was made for humanoid {made_for}, this is {HUMANOID.id}; make it again"
        )
    texts = {name: str(data[name]) for name in _TEXTS}
    poses = [data[name] for name in ("root_pos_w", "root_quat_w", "joint_pos")]
    name = texts.pop("name")
    return clip_from_poses(name, *poses, **texts)


def repeat(clip: Clip, times: int) -> Clip:
    """Return a cyclic clip played several times, each going on from where the last one ended."""
    frames = clip.frames
    poses = [frames.root_pos_w], [frames.root_quat_w], [frames.joint_pos]
    last = frames[-1]
    for _ in range(times - 1):
        turn = rotations.heading_angle(last.root_quat_w) - rotations.heading_angle(frames.root_quat_w[0])
        turned = rotations.rotate(rotations.from_heading(turn), frames.root_pos_w[0])
        offset_w = (last.root_pos_w - turned) * np.array([1.0, 1.0, 0.0])
        again = move(frames[1:], np.full(len(clip) - 1, turn), offset_w)
        for collected, part in zip(
            poses, (again.root_pos_w, again.root_quat_w, again.joint_pos), strict=True
        ):
            collected.append(part)
        last = again[-1]
    joined = [np.concatenate(parts) for parts in poses]
    return clip_from_poses(clip.name, *joined, source=clip.source, licence=clip.licence, label=clip.label)
