"""Samples for the phase-functioned network out of a library's locomotion: what it is given and shall answer.

Every sequence of ``manoeuvres.py`` gets its feet planted and is labelled with contacts, phase and gaits; each
frame t but the last is a sample: input around t, output of t + 1. All of it comes a second time with left and
right exchanged. Takes of some clips are held out.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.progress import track

from unicon import rotations
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip_index import RATE_HZ
from unicon.motion.grounding.contact import Soles
from unicon.motion.grounding.ground import Grounded
from unicon.motion.store.library import ClipLibrary
from unicon.observation import observe
from unicon.schedulers.pfnn.layout import pack_input, pack_output
from unicon.state import CharacterState
from unicon.train.pfnn.manoeuvres import ManoeuvreMaker
from unicon.train.pfnn.path_windows import path_of, windows_ahead, windows_around
from unicon.train.pfnn.phases import label_phases
from unicon.train.pfnn.synthesis import plant
from unicon.train.pfnn.takes import read_takes

_FAST_HINGE = 25.0
"""Takes with a hinge faster than this are no locomotion but a fault [rad/s]."""
_ON_SOLE = 0.25
"""Share of the weight from which on heel or ball counts as touching."""


@dataclass(frozen=True)
class TrainingDataConfig:
    """What is made of a library's locomotion."""

    seed: int = 0
    """Of the draws of speeds and of stretches of standing."""
    held_out: tuple[str, ...] = (
        "07_06",
        "08_02",
        "amp_humanoid_walk",
        "cmu_mb_bvh_16_35",
        "long_walk1",
        "06_09",
    )
    """Clips whose takes are kept from the training, to judge by: those that the library tests with, and more.
    No other clip of the table is of the same capture as one of them."""
    mirrored: bool = True
    """Whether every take comes with left and right exchanged, too."""


class TrainingData(NamedTuple):
    """N samples; consecutive frames of a take are consecutive rows."""

    inputs: np.ndarray
    """``(N, INPUT_SIZE)``, float32."""
    outputs: np.ndarray
    """``(N, OUTPUT_SIZE)``, float32."""
    phases: np.ndarray
    """Of each input, within [0, 2 pi) ``(N,)``, float32."""
    sequences: np.ndarray
    """Which take each sample is of ``(N,)``, int."""
    names: tuple[str, ...]
    """Of the takes."""
    held_out: np.ndarray
    """Which samples are to judge by ``(N,)``."""
    kinds: tuple[str, ...]
    """Of the takes: standing, walking, ..."""


class Samples(NamedTuple):
    """Those of one take."""

    inputs: np.ndarray
    outputs: np.ndarray
    phases: np.ndarray


def make_training_data(
    library: ClipLibrary, config: TrainingDataConfig, console: Console | None = None
) -> TrainingData:
    """Return the samples of all manoeuvres that can be made of a library.

    Raises:
        UniconError: when it has no standing and walking clips of ``takes.yaml``.
    """
    console = console or Console(stderr=True)
    maker = ManoeuvreMaker(read_takes(), library, config.seed, config.held_out)
    manoeuvres = list(maker.all())
    if not manoeuvres:
        raise UniconError(
            f"{library.folder}: has none of the standing and walking clips that the network learns from; "
            "import the free motions with `unicon motions import`"
        )
    if maker.missing:
        console.print(f"not in the library, left out: {', '.join(maker.missing)}")
    parts: list[Samples] = []
    names, kinds = [], []
    for manoeuvre in track(manoeuvres, "locomotion", console=console, transient=True):
        planted = plant(manoeuvre.make())
        if np.abs(planted.frames.joint_vel).max() > _FAST_HINGE:
            continue
        parts.append(samples_of(planted))
        if config.mirrored:
            parts.append(samples_of(mirror(planted)))
        names += [manoeuvre.name, f"{manoeuvre.name} mirrored"][: 2 if config.mirrored else 1]
        kinds += [manoeuvre.kind] * (2 if config.mirrored else 1)
    counts = [len(part.phases) for part in parts]
    sequences = np.repeat(np.arange(len(parts)), counts)
    held = np.array([any(_is_of(name, clip) for clip in config.held_out) for name in names])
    data = TrainingData(
        *(np.concatenate(columns) for columns in zip(*parts, strict=True)),
        sequences=sequences,
        names=tuple(names),
        held_out=held[sequences],
        kinds=tuple(kinds),
    )
    console.print(summary(data))
    return data


def samples_of(planted: Grounded) -> Samples:
    """Return the samples of a take ``(T,)``: T - 1 of them."""
    frames = planted.frames
    count = frames.batch_shape[0] - 1
    at = np.arange(count)
    path = path_of(frames)
    bodies = forward_kinematics(frames)
    phase = label_phases(planted.contact)
    turn = rotations.multiply(rotations.conjugate(rotations.heading(frames.root_quat_w)), frames.root_quat_w)
    pos_h, facing_h = windows_ahead(path, at + 1)
    here = path.heading[:-1]
    step = np.diff(path.pos_w, axis=0) * RATE_HZ
    cos, sin = np.cos(here), np.sin(here)
    parts = {
        "root_vel_h": np.stack(
            [cos * step[:, 0] + sin * step[:, 1], cos * step[:, 1] - sin * step[:, 0]], axis=-1
        ),
        "turn_rate": np.diff(path.heading)[:, None] * RATE_HZ,
        "phase_rate": np.diff(phase)[:, None] * RATE_HZ,
        "contacts": contacts_of(planted, Soles(bodies))[1:],
        "path_pos_h": pos_h,
        "path_facing_h": facing_h,
        "root_height": frames.root_pos_w[1:, 2:],
        "root_rot6d_h": rotations.to_rot6d(turn)[1:],
        "joint_pos": frames.joint_pos[1:],
        "joint_vel": frames.joint_vel[1:],
    }
    inputs = pack_input(windows_around(path, at), observe(frames, bodies)[:-1])
    return Samples(
        inputs.astype(np.float32),
        pack_output(parts).astype(np.float32),
        np.mod(phase[:-1], 2.0 * np.pi).astype(np.float32) % np.float32(2.0 * np.pi),
    )


def contacts_of(planted: Grounded, soles: Soles) -> np.ndarray:
    """Return whether heel and ball of each foot stand ``(T, 4)``, in the order of the layout."""
    touching = planted.contact[:, :, None] & (soles.weights > _ON_SOLE)
    return touching.reshape(len(touching), 4).astype(np.float64)


def mirror(planted: Grounded) -> Grounded:
    """Return a take with left and right exchanged."""
    frames: CharacterState = HUMANOID.mirror(planted.frames)
    return planted._replace(frames=frames, contact=planted.contact[:, ::-1])


def summary(data: TrainingData) -> str:
    """Return in words how much there is of each kind."""
    seconds: defaultdict[str, float] = defaultdict(float)
    for index, count in zip(*np.unique(data.sequences, return_counts=True), strict=True):
        seconds[data.kinds[index]] += int(count) / RATE_HZ
    shares = ", ".join(
        f"{kind} {time / 60:.1f}" for kind, time in sorted(seconds.items(), key=lambda item: -item[1])
    )
    return f"{len(data.phases)} samples of {len(data.names)} takes; minutes: {shares}"


def _is_of(name: str, clip: str) -> bool:
    return name == clip or name.startswith(f"{clip} ")
