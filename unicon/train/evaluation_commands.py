"""`unicon evaluate` and `unicon robustness`: a policy's scores on a person's terminal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar

import tyro
from rich.console import Console

from unicon.errors import UniconError

if TYPE_CHECKING:
    from unicon.policy import Policy
    from unicon.train.scoring.evaluation_clips import ClipSource

Split = Literal["train", "test", "all"]
Outcome = TypeVar("Outcome")
PolicyName = Annotated[str, tyro.conf.Positional]


@dataclass(frozen=True)
class Evaluate:
    """Score a policy: every clip once from its first frame, in MuJoCo at 60 Hz control and 240 Hz physics."""

    policy: PolicyName
    """Name or folder of the policy; also reference_servo, zero, and kinematic (the targets themselves)."""
    library: Path | None = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    clips: Path | None = None
    """Clips (*.npz) or motions of any known format instead: a file, a folder or a zip archive."""
    split: Split = "test"
    """Side of the library; train has the clips of no side, too."""
    dataset: str = "All"
    """Sub-dataset of the paper: All, RunJumpWalk, Casual, SportDance, Animal or Walk."""
    json: Path | None = None
    """File to write all figures to."""
    csv: Path | None = None
    """File to write the figures of classes and clips to."""
    plot: Path | None = None
    """Picture to draw."""
    save: bool = False
    """Write evaluation.json, the card's scores and the model card into the policy's folder."""
    jobs: int = 0
    """Processes; 0: one a core."""

    def run(self, console: Console) -> int:
        """Evaluate, print the tables and write what was asked for."""
        from unicon.train.scoring import evaluation_report as report
        from unicon.train.scoring.evaluation import evaluate
        from unicon.train.scoring.evaluation_runs import find_policy

        policy = find_policy(self.policy)
        folder = _folder_to_save(self.policy, policy) if self.save else None
        source = _open_clips(self.library, self.clips, self.split, self.dataset, self.jobs, console)
        evaluation = _with_progress(
            console,
            len(source.infos),
            lambda tell: evaluate(policy, source, jobs=self.jobs, on_done=tell),
        )
        for table in report.tables(evaluation):
            console.print(table)
        if self.json:
            report.write_json(self.json, report.as_json(evaluation))
        if self.csv:
            report.write_csv(self.csv, evaluation)
        if self.plot:
            report.draw(evaluation, self.plot)
        if folder:
            _save(folder, "evaluation.json", report.as_json(evaluation))
        return 0


@dataclass(frozen=True)
class Robustness:
    """Say how much of its reward a policy keeps: clips faster and slower, body lighter and heavier, balls."""

    policy: PolicyName
    """Name or folder of the policy."""
    library: Path | None = None
    """Folder of the library; $UNICON_LIBRARY or else the shipped one where it is not given."""
    clips: Path | None = None
    """Clips (*.npz) or motions of any known format instead: a file, a folder or a zip archive."""
    split: Split = "test"
    """Side of the library; train has the clips of no side, too."""
    dataset: str = "All"
    """Sub-dataset of the paper: All, RunJumpWalk, Casual, SportDance, Animal or Walk."""
    json: Path | None = None
    """File to write the figures to."""
    save: bool = False
    """Write robustness.json, the card's scores and the model card into the policy's folder."""
    jobs: int = 0
    """Processes; 0: one a core."""

    def run(self, console: Console) -> int:
        """Run all trials, print the table and write what was asked for."""
        from unicon.train.scoring import robustness as trials
        from unicon.train.scoring.evaluation_report import write_json
        from unicon.train.scoring.evaluation_runs import find_policy

        policy = find_policy(self.policy)
        folder = _folder_to_save(self.policy, policy) if self.save else None
        source = _open_clips(self.library, self.clips, self.split, self.dataset, self.jobs, console)
        outcomes = _with_progress(
            console,
            len(source.infos) * (1 + len(trials.TRIALS)),
            lambda tell: trials.measure_robustness(policy, source, self.jobs, on_done=tell),
        )
        console.print(trials.robustness_table(policy.name, source.title, outcomes))
        values = trials.robustness_as_json(policy.name, source.title, outcomes)
        if self.json:
            write_json(self.json, values)
        if folder:
            _save(folder, "robustness.json", values)
        return 0


def _open_clips(
    library: Path | None, clips: Path | None, split: Split, dataset: str, jobs: int, console: Console
) -> ClipSource:
    from unicon.motion.importing.worker_pool import core_count
    from unicon.motion.store.library_choice import open_library
    from unicon.train.scoring.evaluation_clips import from_library, from_path

    if clips and library:
        raise UniconError("give --library or --clips, not both")
    if clips:
        return from_path(clips, jobs or core_count(), console)
    return from_library(open_library(library, console), dataset, split)


def _with_progress(console: Console, total: int, work: Callable[[Callable[[int], None]], Outcome]) -> Outcome:
    """Do work under a progress bar; it is given what tells how many more clips are done."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("clips"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("clips", total=total)
        return work(lambda count: progress.advance(task, count))


def _folder_to_save(name: str, policy: Policy) -> Path:
    """Return the folder of a policy.

    Raises:
        UniconError: when it has none.
    """
    from unicon.policy_library import policies_folder

    if not policy.trained:
        raise UniconError(f"--save: {name} has no folder to write into; use --json FILE")
    folder = Path(name)
    return folder if folder.is_dir() else policies_folder() / name


def _save(folder: Path, file: str, values: dict[str, Any]) -> None:
    from unicon.train.scoring.evaluation_report import write_json
    from unicon.train.scoring.policy_export import take_in_scores

    write_json(folder / file, values)
    take_in_scores(folder)
