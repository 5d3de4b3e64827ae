"""Training data of a toy gait: the next pose follows from phase and path alone."""

from __future__ import annotations

import numpy as np

from unicon.schedulers.pfnn.layout import (
    AHEAD,
    INPUT_SIZE,
    OUTPUT_LAYOUT,
    PRESENT,
    SAMPLES,
    PathSamples,
    pack_input,
    pack_output,
)
from unicon.train.pfnn.training_data import TrainingData


def make_toy_data(takes: int = 4, frames: int = 300) -> TrainingData:
    """Walks straight ahead, faster from take to take; the last take but one is held out."""
    rng = np.random.default_rng(1)
    directions = rng.standard_normal((2, 35))
    speeds = np.linspace(0.8, 1.6, takes)
    inputs, outputs, phases = [], [], []
    for speed in speeds:
        rate = 2 * np.pi * 0.7 * speed
        phase = (rate * np.arange(frames + 1) / 60.0) % (2 * np.pi)
        inputs.append(_inputs(phase[:-1], speed, directions))
        outputs.append(_outputs(phase[1:], speed, rate, directions))
        phases.append(phase[:-1])
    sequences = np.repeat(np.arange(takes), frames)
    return TrainingData(
        np.concatenate(inputs).astype(np.float32),
        np.concatenate(outputs).astype(np.float32),
        np.concatenate(phases).astype(np.float32),
        sequences,
        tuple(f"walk_{index}" for index in range(takes)),
        sequences == takes - 2,
        ("walking",) * takes,
    )


def _path(frames: int, speed: float, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pos_h = np.zeros((frames, len(samples), 2))
    pos_h[..., 0] = speed * samples / 6.0
    facing_h = np.zeros_like(pos_h)
    facing_h[..., 0] = 1.0
    return pos_h, facing_h


def _joints(phase: np.ndarray, directions: np.ndarray) -> np.ndarray:
    return 0.3 * (np.sin(phase)[:, None] * directions[0] + np.cos(phase)[:, None] * directions[1])


def _inputs(phase: np.ndarray, speed: float, directions: np.ndarray) -> np.ndarray:
    frames = len(phase)
    pose = np.zeros((frames, 197))
    pose[:, 0] = 0.9
    pose[:, -70:-35] = _joints(phase, directions)
    gait = np.zeros((frames, SAMPLES, 5))
    gait[..., 1] = 1.0
    x = pack_input(PathSamples(*_path(frames, speed, np.arange(SAMPLES) - PRESENT), gait), pose)
    assert x.shape == (frames, INPUT_SIZE)
    return x


def _outputs(phase: np.ndarray, speed: float, rate: float, directions: np.ndarray) -> np.ndarray:
    frames = len(phase)
    parts = {name: np.zeros((frames, *shape)) for name, shape in OUTPUT_LAYOUT}
    parts["root_vel_h"][:, 0] = speed
    parts["phase_rate"][:] = rate
    parts["contacts"][:, :2] = (phase < np.pi)[:, None]
    parts["contacts"][:, 2:] = (phase >= np.pi)[:, None]
    parts["path_pos_h"], parts["path_facing_h"] = _path(frames, speed, np.arange(AHEAD))
    parts["root_height"][:] = 0.9
    parts["root_rot6d_h"][:, [0, 4]] = 1.0
    parts["joint_pos"] = _joints(phase, directions)
    parts["joint_vel"] = rate * _joints(phase + np.pi / 2, directions)
    return pack_output(parts)
