"""The paper's table of robustness: how much of its reward a policy keeps when things are made harder.

    speed         clips played 0.4 to 1.6 times as fast, resampled to 60 Hz
    mass          every body 25 % lighter or heavier, torques unchanged
    projectiles   a ball every 80 to every single tick (`unicon.projectile.Barrage` has size, mass, speed and
                  aim); thrown by `unicon.simulation.Simulation.throw`, as the executor's are

Nothing is trained anew. What is compared is the reward of `ClipScores`: the sum until a term breaks the
constraint, over the ticks of the clip as it is played, mean over clips. It is given relative to that of the
same clips without any of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from rich.table import Table

from unicon.humanoid import HUMANOID
from unicon.policy import Policy
from unicon.projectile import Barrage
from unicon.train.scoring.evaluation import UNPERTURBED, Group, evaluate, summarise
from unicon.train.scoring.evaluation_clips import ClipSource
from unicon.train.scoring.evaluation_runs import Perturbation

FORMAT = "unicon-robustness-1"
SPEEDS = (0.4, 0.6, 0.8, 1.2, 1.4, 1.6)
MASSES = (0.75, 1.25)
THROWS = (80, 40, 20, 10, 5, 1)
PAPER_ROWS = ("paper: UniCon", "paper: baseline")
PAPER: dict[str, tuple[float, float]] = {}
"""The paper's two rows by our column, in per cent. Its text was not at hand: none is stated."""


class Trial(NamedTuple):
    """One column of the table."""

    name: str
    perturbation: Perturbation


class Outcome(NamedTuple):
    """What came of a trial."""

    name: str
    relative_reward: float
    """The reward over the unperturbed one; not a number where that is 0."""
    group: Group
    """All figures of all clips."""


TRIALS = (
    *(Trial(f"speed {speed:g}", Perturbation(speed=speed)) for speed in SPEEDS),
    *(Trial(f"mass x {mass:g}", Perturbation(mass=mass)) for mass in MASSES),
    *(Trial(f"ball every {ticks}", Perturbation(barrage=Barrage(ticks))) for ticks in THROWS),
)


def measure_robustness(
    policy: Policy,
    source: ClipSource,
    jobs: int = 0,
    trials: Sequence[Trial] = TRIALS,
    on_done: Callable[[int], None] = lambda clips: None,
) -> list[Outcome]:
    """Run all trials, the unperturbed one first.

    Raises:
        UniconError: when a process was killed.
    """
    outcomes: list[Outcome] = []
    for trial in (Trial("unperturbed", UNPERTURBED), *trials):
        group = summarise(evaluate(policy, source, trial.perturbation, jobs, on_done))[0]
        usual = outcomes[0].group.figures["reward"] if outcomes else group.figures["reward"]
        relative = group.figures["reward"] / usual if usual else float("nan")
        outcomes.append(Outcome(trial.name, relative, group))
    return outcomes


def robustness_table(policy: str, clips: str, outcomes: Sequence[Outcome]) -> Table:
    """Return the table: a row a trial, the paper's two rows as columns beside ours."""
    table = Table(title=f"{policy}: {clips}, reward relative to the unperturbed")
    table.add_column("")
    for heading in ("reward", "relative", "survival", "S1", *PAPER_ROWS):
        table.add_column(heading, justify="right")
    for outcome in outcomes:
        figures = outcome.group.figures
        ours = (f"{figures['reward']:.3f}", f"{outcome.relative_reward:.1%}")
        ours = (*ours, f"{figures['survival']:.3f}", f"{figures['success']:.1%}")
        paper = PAPER.get(outcome.name)
        table.add_row(outcome.name, *ours, *(f"{v:.1f}%" for v in paper) if paper else ("not stated",) * 2)
    return table


def robustness_as_json(policy: str, clips: str, outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return the table for a file."""
    return {
        "format": FORMAT,
        "policy": policy,
        "clips": clips,
        "humanoid_id": HUMANOID.id,
        "projectiles": {**vars(Barrage(1)), "every_ticks": list(THROWS), "body": "drawn evenly of all 20"},
        "trials": [
            {
                "name": outcome.name,
                "relative_reward": _number(outcome.relative_reward),
                **{name: _number(outcome.group.figures[name]) for name in ("reward", "survival", "success")},
                "paper": PAPER.get(outcome.name),
            }
            for outcome in outcomes
        ],
    }


def _number(value: float) -> float | None:
    return round(value, 6) if value == value else None
