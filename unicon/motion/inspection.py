"""`unicon motions inspect`: a clip's figures as tables, and its plots as one picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from unicon import rotations
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip import Clip
from unicon.motion.clip_index import RATE_HZ, ClipInfo
from unicon.motion.grounding.contact import ContactConfig, Soles, find_contacts
from unicon.motion.grounding.quality import NEAR_LIMIT_RAD, measure

LEFT, RIGHT, DARK = "#0072B2", "#D55E00", "#333333"
SHOWN_HINGES = 3
"""How many of the hinges that are most at their limits are named."""


class Inspection(NamedTuple):
    """A clip of T frames and what is found in it."""

    clip: Clip
    info: ClipInfo
    quality: Mapping[str, float]
    """The figures of its retargeting; of a clip by itself, those that need no source."""
    soles: Soles
    contact: np.ndarray
    """When the left and the right foot stand ``(T, 2)``."""
    at_limit: np.ndarray
    """Which hinges are within half a degree of a limit ``(T, 35)``."""


def inspect(clip: Clip, info: ClipInfo | None = None) -> Inspection:
    """Examine a clip; ``info`` is its row of a library."""
    frames = clip.frames
    soles = Soles(forward_kinematics(frames))
    contact = find_contacts(soles, frames.root_pos_w, ContactConfig())
    if info is None:
        info = ClipInfo(clip.name, len(clip), clip.label or "other", "", clip.source, clip.licence)
    quality = info.quality or measure(frames, contact).to_dict()
    low = frames.joint_pos < HUMANOID.joint_lower + NEAR_LIMIT_RAD
    high = frames.joint_pos > HUMANOID.joint_upper - NEAR_LIMIT_RAD
    return Inspection(clip, info, quality, soles, contact, low | high)


def show(inspection: Inspection, console: Console) -> None:
    """Print what the clip is, its figures, and which hinges are most at their limits."""
    info = inspection.info
    facts = {
        "length": f"{info.seconds:.2f} s, {info.frames} frames",
        "class": info.label,
        "marks": ", ".join(info.marks) or "none",
        "source": info.source or "not stated",
        "licence": info.licence or "not stated",
        "made from": info.origin,
        "take": info.take,
        "split": info.split,
    }
    table = Table("clip", escape(info.name))
    for name, text in facts.items():
        if text:
            table.add_row(name, escape(text))
    console.print(table)
    figures = Table("figure", "value")
    for name, value in inspection.quality.items():
        figures.add_row(name, f"{value:.4g}" if np.isfinite(value) else "not measured")
    for name, share in _worst_hinges(inspection):
        figures.add_row(f"{name} at its limit", f"{100 * share:.1f} % of the frames")
    console.print(figures)


def plot(inspection: Inspection, path: Path) -> None:
    """Write the plots as one PNG: root path from above, foot heights and contacts, root speed, hinges.

    Raises:
        UniconError: when the picture cannot be written.
    """
    figure = Figure(figsize=(14, 11), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.6), height_ratios=(1, 1, 2.2))
    info = inspection.info
    figure.suptitle(f"{info.name}   {info.label}   {info.seconds:.1f} s", parse_math=False)
    _plot_path(figure.add_subplot(grid[:2, 0]), inspection)
    heights = figure.add_subplot(grid[0, 1])
    _plot_feet(heights, inspection)
    _plot_speed(figure.add_subplot(grid[1, 1], sharex=heights), inspection)
    _plot_hinges(figure.add_subplot(grid[2, :]), inspection)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=100, format="png")
    except OSError as error:
        raise UniconError(f"{path}: the plots cannot be written ({error.strerror or error})") from error


def _worst_hinges(inspection: Inspection) -> list[tuple[str, float]]:
    shares = inspection.at_limit.mean(axis=0)
    worst = np.argsort(-shares)[:SHOWN_HINGES]
    return [(HUMANOID.joint_names[i], float(shares[i])) for i in worst if shares[i] > 0]


def _times_s(inspection: Inspection) -> np.ndarray:
    return np.arange(len(inspection.clip)) / RATE_HZ


def _plot_path(axes: Axes, inspection: Inspection) -> None:
    """Draw the root from above, an arrow a second where it faces, and where the feet stand."""
    frames = inspection.clip.frames
    for foot, colour in enumerate((LEFT, RIGHT)):
        points = inspection.soles.points_w[inspection.contact[:, foot], foot, :, :2].reshape(-1, 2)
        axes.plot(*points.T, ".", color=colour, markersize=2, alpha=0.3)
    axes.plot(*frames.root_pos_w[:, :2].T, color=DARK, linewidth=1.2)
    axes.plot(*frames.root_pos_w[0, :2], "o", color=DARK, markersize=6)
    step = max(int(RATE_HZ), len(inspection.clip) // 40)
    places, headings = frames.root_pos_w[::step, :2], rotations.heading_angle(frames.root_quat_w[::step])
    axes.quiver(*places.T, np.cos(headings), np.sin(headings), color=DARK, width=0.004, scale=18)
    axes.set(title="root path from above (dot: start, arrows: facing)", xlabel="x [m]", ylabel="y [m]")
    _make_square(axes)
    axes.grid(alpha=0.3)


def _make_square(axes: Axes) -> None:
    """Show as much of x as of y and at least 2 m, so that a person who stands does not fill the picture."""
    limits = np.array([axes.get_xlim(), axes.get_ylim()])
    half = max(0.5 * np.ptp(limits, axis=1).max(), 1.0)
    middle_x, middle_y = limits.mean(axis=1)
    axes.set(xlim=(middle_x - half, middle_x + half), ylim=(middle_y - half, middle_y + half), aspect="equal")


def _plot_feet(axes: Axes, inspection: Inspection) -> None:
    times_s, heights_cm = _times_s(inspection), 100 * inspection.soles.heights
    for foot, (name, colour) in enumerate((("left", LEFT), ("right", RIGHT))):
        axes.plot(times_s, heights_cm[:, foot], color=colour, linewidth=1.0, label=name)
        bar = np.where(inspection.contact[:, foot], -3.0 - 2.0 * foot, np.nan)
        axes.plot(times_s, bar, color=colour, linewidth=4, solid_capstyle="butt")
    axes.axhline(0.0, color=DARK, linewidth=0.8)
    axes.set(title="lowest point of the soles (bars: contact)", ylabel="height [cm]")
    axes.legend(loc="upper right")
    axes.grid(alpha=0.3)


def _plot_speed(axes: Axes, inspection: Inspection) -> None:
    times_s, velocity_w = _times_s(inspection), inspection.clip.frames.root_lin_vel_w
    axes.plot(
        times_s, np.linalg.norm(velocity_w[:, :2], axis=1), color=DARK, linewidth=1.0, label="horizontal"
    )
    axes.plot(times_s, velocity_w[:, 2], color="#009E73", linewidth=1.0, label="vertical")
    axes.set(title="root speed", xlabel="time [s]", ylabel="speed [m/s]")
    axes.legend(loc="upper right")
    axes.grid(alpha=0.3)


def _plot_hinges(axes: Axes, inspection: Inspection) -> None:
    """Draw each hinge's place in its range as a colour, and dots where it is at a limit."""
    lower, upper = HUMANOID.joint_lower, HUMANOID.joint_upper
    place = 2.0 * (inspection.clip.frames.joint_pos - lower) / (upper - lower) - 1.0
    duration_s = len(inspection.clip) / RATE_HZ
    extent = (0.0, duration_s, len(lower) - 0.5, -0.5)
    image = axes.imshow(place.T, cmap="RdBu_r", vmin=-1, vmax=1, aspect="auto", extent=extent)
    frames, hinges = np.nonzero(inspection.at_limit)
    axes.plot(frames / RATE_HZ, hinges, "k.", markersize=3)
    axes.set_yticks(range(len(lower)), HUMANOID.joint_names, fontsize=7)
    saturated = 100 * inspection.at_limit.mean()
    axes.set(title=f"hinges in their ranges (dots: at a limit, {saturated:.1f} % of all)", xlabel="time [s]")
    bar = axes.figure.colorbar(image, ax=axes, pad=0.01, ticks=[-1, 0, 1])
    bar.ax.set_yticklabels(["lower limit", "middle", "upper limit"], fontsize=7)
