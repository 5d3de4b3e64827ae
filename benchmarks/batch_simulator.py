"""The batch simulator beside MuJoCo's own rollout: control steps a second of both in one run, on one thread.

Both simulate the same model from the same states under the same servo controls, 60 Hz with four physics
steps; the batch simulator also observes (tau 1) and computes the reward. In `standing` the avatars
sway on their feet, in `fallen` they wriggle on the floor. The two take turns and the best of several turns
counts, so that other programs disturb little. Writes out/bench/batch_simulator.json.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import tyro
from mujoco import rollout

from unicon.control import ServoControl
from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import MOTOR_GROUP, compile_model
from unicon.reward import reward_terms, total_reward
from unicon.train.environment.batch_simulator.build import processor
from unicon.train.environment.batch_simulator.kernel import load_kernel
from unicon.train.environment.batch_simulator.simulator import BatchSimulator, BatchSimulatorConfig

SCENES = {"standing": 0.03, "fallen": 0.4}
"""Spread of the servos' aims [rad]."""
VECTORS = ("avx2", "avx512f", "avx512_bf16")


@dataclass(frozen=True)
class BenchConfig:
    """How much to measure, and where to write."""

    envs: int = 1024
    ticks: int = 30
    mujoco_envs: int = 64
    turns: int = 5
    solves: int = 6
    """BatchSimulatorConfig.constraint_solves."""
    out: Path = Path("out/bench/batch_simulator.json")


class Scene:
    """States one second after standing up under aims of some spread, and the controls that go on."""

    def __init__(self, config: BenchConfig, spread_rad: float) -> None:
        self.config = config
        rng = np.random.default_rng(0)
        shape = (config.envs, len(HUMANOID.joint_names))
        aims = (spread_rad * rng.standard_normal(shape)).astype(np.float32)
        self.control = ServoControl(aims, np.zeros_like(aims))
        simulator = self.simulator(threads=1)
        self.target = simulator.rows.copy()
        for _ in range(60):
            simulator.step(self.control)
        self.start = simulator.rows.copy()

    def simulator(self, threads: int) -> BatchSimulator:
        """Return a batch simulator with the settings to measure."""
        options = BatchSimulatorConfig(threads=threads, constraint_solves=self.config.solves)
        return BatchSimulator(self.config.envs, options)

    def time_batch(self) -> float:
        """Return control steps a second, with observation and reward."""
        simulator = self.simulator(threads=1)
        simulator.rows[:] = self.start
        began = time.perf_counter()
        for _ in range(self.config.ticks):
            simulator.step(self.control)
            total_reward(reward_terms(simulator.errors(self.target)))
            simulator.observe(self.target[:, None])
        return self.config.envs * self.config.ticks / (time.perf_counter() - began)

    def time_ticks(self, threads: int) -> tuple[float, float]:
        """Return the shortest time and the mean processor time of a tick [s]."""
        simulator = self.simulator(threads)
        simulator.rows[:] = self.start
        processor_start, times = time.process_time(), []
        for _ in range(self.config.ticks):
            began = time.perf_counter()
            simulator.step(self.control)
            times.append(time.perf_counter() - began)
        return min(times), (time.process_time() - processor_start) / self.config.ticks

    def scaling(self) -> dict[str, float]:
        """Return how much two threads are faster than one.

        By the clock, which needs two idle cores; and by the processor time that both threads take together,
        which tells what sharing the work costs on a busy machine, too.
        """
        turns = [self.time_ticks(1) + self.time_ticks(2) for _ in range(4 * self.config.turns)]
        clock_1, processor_1, clock_2, processor_2 = np.min(turns, axis=0)
        return {
            "scaling_to_2_threads": clock_1 / clock_2,
            "scaling_by_processor_time": 2.0 * processor_1 / processor_2,
        }

    def time_mujoco(self) -> float:
        """Return control steps a second, physics alone."""
        count, model = self.config.mujoco_envs, compile_model()
        model.opt.disableactuator = 1 << MOTOR_GROUP
        simulator = self.simulator(threads=1)
        simulator.rows[:] = self.start
        qpos, qvel = simulator.state()[:count].to_mujoco()
        states = np.concatenate([np.zeros((count, 1)), qpos, qvel], axis=1)
        aims = self.control.joint_pos[:count, None]
        control = np.concatenate([np.zeros_like(aims), aims], axis=2).astype(float)
        began = time.perf_counter()
        rollout.rollout(model, [mujoco.MjData(model)], states, control, nstep=4 * self.config.ticks)
        return count * self.config.ticks / (time.perf_counter() - began)


def best_of_turns(turns: int, measures: dict[str, Callable[[], float]]) -> dict[str, float]:
    """Let the measures take turns; return the best of each."""
    best = dict.fromkeys(measures, 0.0)
    for _ in range(turns):
        for name, measure in measures.items():
            best[name] = max(best[name], measure())
    return best


def measure_scene(config: BenchConfig, spread_rad: float) -> dict[str, float]:
    """Return the figures of one scene."""
    scene = Scene(config, spread_rad)
    measures: dict[str, Callable[[], float]] = {
        "batch_steps_per_s": scene.time_batch,
        "mujoco_steps_per_s": scene.time_mujoco,
    }
    figures = best_of_turns(config.turns, measures)
    figures["times_mujoco"] = figures["batch_steps_per_s"] / figures["mujoco_steps_per_s"]
    return figures | scene.scaling()


def main() -> None:
    """Measure and write the figures."""
    config = tyro.cli(BenchConfig, prog="benchmarks/batch_simulator.py", description=__doc__)
    flags = processor().split()
    figures: dict[str, object] = {
        "lanes": load_kernel().unicon_lanes(),
        "processor_has": [flag for flag in VECTORS if flag in flags],
        "envs": config.envs,
        "constraint_solves": config.solves,
    }
    for name, spread_rad in SCENES.items():
        figures[name] = {key: round(value, 2) for key, value in measure_scene(config, spread_rad).items()}
    config.out.parent.mkdir(parents=True, exist_ok=True)
    config.out.write_text(json.dumps(figures, indent=2) + "\n")
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
