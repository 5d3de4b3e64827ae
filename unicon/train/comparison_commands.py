"""`unicon compare`: recipes and switches side by side."""

from __future__ import annotations

import shlex
import sys
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

BASELINES = ("paper", "pd", "kinematic_state", "chentanez", "deepmimic_onehot", "deepmimic_variable")


@dataclass(frozen=True)
class Compare:
    """Train recipes one after the other with the same budget, and put their scores and curves side by side.

    What is finished in the folder is not done again; what was stopped goes on.
    """

    out: Path
    """Folder of the runs, of comparison.json, .csv, .md and .png."""
    recipes: tuple[str, ...] = BASELINES
    """Names or files of recipes; +no-balancer, +no-failures, +no-variance-controller, +no-constraint or
    +no-rsis behind one leaves that out, and +ppo.epochs=1 changes a setting."""
    minutes: float = 30.0
    """Budget of each, in minutes of processor time summed over threads: other work on the machine does not
    count."""
    dataset: str = "Walk"
    """Sub-dataset to learn and to be scored on: All, RunJumpWalk, Casual, SportDance, Animal or Walk."""
    library: Path | None = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    set: tuple[str, ...] = ()
    """Settings of all, e.g. smaller networks: network.actor_sizes=[256,256] environment.num_envs=1024."""
    curve_points: int = 6
    """How often each is scored while it learns."""
    jobs: int = 0
    """Processes of an evaluation; 0: one a core."""

    def run(self, console: Console) -> int:
        """Train and score what is missing, and print the table."""
        from unicon.errors import UniconError
        from unicon.motion.store.library_choice import open_library
        from unicon.train.scoring.comparison import ComparisonConfig, compare
        from unicon.train.scoring.comparison_report import table

        if self.minutes <= 0 or self.curve_points < 1:
            raise UniconError("--minutes has to be above 0, and --curve-points 1 or more")
        config = ComparisonConfig(self.minutes, self.dataset, self.jobs, self.curve_points)
        library = open_library(self.library, console)
        outcomes = compare(library, self.out, self.recipes, config, console, self.set)
        if len(outcomes) < len(self.recipes):
            again = shlex.join(["unicon", *sys.argv[1:]])
            console.print(f"stopped; go on with: {again}", soft_wrap=True, highlight=False)
            return 130
        console.print(table(outcomes, self.dataset))
        console.print(str(self.out), soft_wrap=True)
        return 0
