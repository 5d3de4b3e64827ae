"""`make bench-train`: how fast the trainer is, beside MuJoCo's rollout and stable-baselines3's PPO.

The batch simulator with observation and reward beside `mujoco.rollout`, on one thread and on two; the recipe
`laptop` end to end beside stable-baselines3's PPO on the same environment in MuJoCo, with equal networks,
batches and epochs; the learner's arithmetic beside a bare product. All on one core, but the two threads.
The competitors take turns, and medians count; other programs slow all down and leave the ratios.
Writes out/bench/train.json.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import tyro
from batch_simulator import SCENES, Scene
from batch_simulator import BenchConfig as SimulatorConfig
from learner_speed import OurTraining, time_matmul
from rich.console import Console
from rich.progress import Progress
from rich.table import Table
from sb3_ppo import Sb3Training

from unicon.errors import UniconError
from unicon.motion.store.library_choice import open_library
from unicon.train.environment.dataset import DatasetConfig, choose_clips
from unicon.train.runs.recipe import read_recipe

KEYS = (
    "batch_steps_per_s",
    "mujoco_steps_per_s",
    "batch_thread_scaling",
    "ppo_samples_per_s",
    "sb3_samples_per_s",
    "learner_gflops",
    "matmul_gflops",
)


@dataclass(frozen=True)
class BenchConfig:
    """What to measure, and where to write."""

    recipe: str = "laptop"
    """What learns."""
    library: Path | None = None
    """Library to learn from; $UNICON_LIBRARY or else the shipped one where it is not given."""
    dataset: str = "All"
    """Sub-dataset to learn from."""
    turns: int = 5
    """How often each is measured; the median counts."""
    out: Path = Path("out/bench/train.json")


def take_turns(turns: int, measures: dict[str, Callable[[], float]], progress: Progress) -> dict[str, float]:
    """Let the measures take turns, once before it counts; return the median of each."""
    task = progress.add_task(", ".join(measures), total=turns + 1)
    values: dict[str, list[float]] = {name: [] for name in measures}
    for _ in range(turns + 1):
        for name, measure in measures.items():
            values[name].append(measure())
        progress.advance(task)
    return {name: median(each[1:]) for name, each in values.items()}


def measure(config: BenchConfig, console: Console) -> dict[str, float]:
    """Return all figures.

    Raises:
        UniconError: when there is no such recipe or library.
    """
    recipe = read_recipe(config.recipe)
    dataset = choose_clips(open_library(config.library, console), DatasetConfig(config.dataset))
    scene = Scene(SimulatorConfig(turns=config.turns), SCENES["standing"])
    cores = os.sched_getaffinity(0)
    with Progress(console=console) as progress:
        figures = {"batch_thread_scaling": scene.scaling()["scaling_to_2_threads"]}
        os.sched_setaffinity(0, {min(cores)})
        try:
            ours, theirs = OurTraining(dataset, recipe), Sb3Training(dataset, recipe)
            for measures in (
                {"batch_steps_per_s": scene.time_batch, "mujoco_steps_per_s": scene.time_mujoco},
                {"ppo_samples_per_s": ours.time_iteration, "sb3_samples_per_s": theirs.time_iteration},
                {"learner_gflops": ours.time_update, "matmul_gflops": lambda: time_matmul(recipe)},
            ):
                figures |= take_turns(config.turns, measures, progress)
        finally:
            os.sched_setaffinity(0, cores)
    return {key: round(figures[key], 3) for key in KEYS}


def to_table(figures: dict[str, float]) -> Table:
    """Return the figures side by side, with their ratios."""
    table = Table("one core", "ours", "beside", "ratio", title="trainer")
    for column in table.columns[1:]:
        column.justify = "right"
    for label, ours, name, theirs in (
        ("control steps/s, 4 physics steps", "batch_steps_per_s", "mujoco.rollout", "mujoco_steps_per_s"),
        ("PPO, samples/s", "ppo_samples_per_s", "stable-baselines3", "sb3_samples_per_s"),
        ("learner, GFLOP/s", "learner_gflops", "bare product", "matmul_gflops"),
    ):
        a, b = figures[ours], figures[theirs]
        table.add_row(label, f"{a:,.0f}", f"{name} {b:,.0f}", f"{a / b:.2f} x")
    table.add_row("simulator on two threads", "", "on one", f"{figures['batch_thread_scaling']:.2f} x")
    return table


def main() -> int:
    """Measure and write the figures; return the exit status."""
    config = tyro.cli(BenchConfig, prog="make bench-train", description=__doc__)
    console = Console()
    try:
        figures = measure(config, console)
    except UniconError as error:
        print(f"bench-train: {error}", file=sys.stderr)
        return 2
    console.print(to_table(figures))
    config.out.parent.mkdir(parents=True, exist_ok=True)
    config.out.write_text(json.dumps(figures, indent=2) + "\n")
    console.print(f"written to {config.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
