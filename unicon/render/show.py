"""`unicon render`: a video and a contact sheet of a clip or a recording."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import imageio.v2 as imageio
import numpy as np
from PIL import Image
from rich.console import Console
from rich.progress import track

from unicon.errors import InputFileError
from unicon.motion.clip import RATE_HZ
from unicon.render.camera import CameraConfig
from unicon.render.scene import Picture
from unicon.render.stage import Layout, Stage
from unicon.render.take import Take

BORDER_PX = 6
BORDER_COLOUR = (255, 255, 255)


@dataclass(frozen=True)
class RenderConfig:
    """What to draw, and how."""

    video: Path | None = None
    """MP4 to write; none where it is not given."""
    contact_sheet: Path | None = None
    """PNG to write; none where it is not given."""
    layout: Layout = "overlay"
    """Target in white and avatar in yellow: one through the other, or side by side."""
    fps: int = 30
    """Frames per second of the video."""
    start_s: float = 0.0
    """Where to begin."""
    duration_s: float = 0.0
    """How much to show; 0 for all."""
    columns: int = 4
    """Pictures in a row of the contact sheet."""
    rows: int = 3
    """Rows of the contact sheet."""
    picture: Picture = field(default_factory=Picture)
    camera: CameraConfig = field(default_factory=CameraConfig)


def render(take: Take, config: RenderConfig, console: Console) -> None:
    """Write the video and the contact sheet that the configuration asks for.

    Raises:
        InputFileError: when the chosen part is empty.
        NoGLError: when nothing on this machine can draw.
    """
    take = _cut(take, config)
    with Stage(take, config.picture, config.camera, config.layout) as stage:
        if config.contact_sheet is not None:
            _write_contact_sheet(stage, len(take.times_s), config, console)
        if config.video is not None:
            _write_video(stage, take, config, console)


def _cut(take: Take, config: RenderConfig) -> Take:
    stop_s = config.start_s + config.duration_s if config.duration_s > 0 else np.inf
    chosen = np.flatnonzero((take.times_s >= config.start_s) & (take.times_s < stop_s))
    if not len(chosen):
        whole = f"0 to {take.times_s[-1]:.2f} s"
        raise InputFileError(f"nothing lies between {config.start_s} and {stop_s} s; there is {whole}")
    return take[chosen[0] : chosen[-1] + 1]


def _write_video(stage: Stage, take: Take, config: RenderConfig, console: Console) -> None:
    assert config.video is not None
    config.video.parent.mkdir(parents=True, exist_ok=True)
    frames = np.unique(np.arange(0, len(take.times_s), RATE_HZ / config.fps).astype(int))
    writer = imageio.get_writer(
        config.video,
        fps=config.fps,
        codec="libx264",
        pixelformat="yuv420p",
        macro_block_size=2,
        output_params=["-movflags", "+faststart", "-preset", "veryfast"],
    )
    with writer:
        for frame in _progress(frames, f"drawing {config.video.name}", console):
            writer.append_data(stage.draw(frame))


def _write_contact_sheet(stage: Stage, count: int, config: RenderConfig, console: Console) -> None:
    assert config.contact_sheet is not None
    config.contact_sheet.parent.mkdir(parents=True, exist_ok=True)
    number = config.columns * config.rows
    frames = np.linspace(0, count - 1, number).round().astype(int)
    pictures = [stage.draw(f) for f in _progress(frames, f"drawing {config.contact_sheet.name}", console)]
    Image.fromarray(tile(pictures, config.columns)).save(config.contact_sheet)


def tile(pictures: list[np.ndarray], columns: int) -> np.ndarray:
    """Return pictures ``(h, w, 3)`` in rows and columns, with a border."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    step_y, step_x = height + BORDER_PX, width + BORDER_PX
    sheet = np.full((rows * step_y + BORDER_PX, columns * step_x + BORDER_PX, 3), BORDER_COLOUR, np.uint8)
    for index, picture in enumerate(pictures):
        y, x = BORDER_PX + index // columns * step_y, BORDER_PX + index % columns * step_x
        sheet[y : y + height, x : x + width] = picture
    return sheet


def _progress(frames: np.ndarray, label: str, console: Console) -> Iterable[int]:
    return track(frames.tolist(), label, console=console, transient=True)
