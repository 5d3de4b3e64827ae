"""`unicon pfnn train` and `unicon pfnn convert`: torch is imported only when they are called."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro
from rich.console import Console

from unicon.train.pfnn.training_config import NetworkTrainingConfig
from unicon.train.pfnn.training_data import TrainingDataConfig

if TYPE_CHECKING:
    from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
    from unicon.train.pfnn.training_run import NetworkTrainingRun


@dataclass(frozen=True)
class NetworkSettings:
    """All settings of the training of a network, as config.yaml in the folder of its run has them."""

    training: NetworkTrainingConfig = field(default_factory=NetworkTrainingConfig)
    """The network and how it learns."""
    data: TrainingDataConfig = field(default_factory=TrainingDataConfig)
    """What is made of the motions."""


@dataclass(frozen=True)
class PfnnTrain:
    """Train the network of the keyboard scheduler on the locomotion clips of a library.

    The folder of the run holds settings, log and state, and in pfnn/ the network with its model card and
    curves, ready to be copied to policies/NAME.
    """

    library: Path
    """Library of motions to learn from, as `unicon motions import` makes it."""
    out: Path
    """Folder of the run."""
    minutes: float | None = None
    """Budget of training time [min], without the time that making the data takes."""
    seed: int | None = None
    """Of everything that is drawn."""
    resume: bool = False
    """Go on with the run in the folder, with its settings; --minutes may prolong it."""
    settings: Annotated[NetworkSettings, tyro.conf.arg(name="")] = field(default_factory=NetworkSettings)

    def run(self, console: Console) -> int:
        """Train until the budget is spent or Ctrl-C."""
        settings = self.read_settings()
        run = self._prepare(settings, console)
        ending = run.train()
        done = f"{ending} after {run.trainer.steps} steps, {run.seconds / 60.0:.1f} min"
        go_on = shlex.join(
            ["unicon", "pfnn", "train", "--library", str(self.library), "--out", str(self.out), "--resume"]
        )
        network = f"the network is in {run.network_folder}"
        next_step = f"go on with: {go_on}" if ending == "stopped" else network
        console.print(f"{done}; {next_step}", soft_wrap=True, highlight=False)
        return 0

    def read_settings(self) -> NetworkSettings:
        """Return the settings: those of the command, or of the run to go on with.

        Raises:
            UniconError: when they cannot be read, or a new run finds another there.
        """
        from unicon.train.pfnn.settings_file import SETTINGS_FILE, open_settings

        settings = open_settings(self.out, NetworkSettings) if self.resume else self.settings
        if self.resume:
            self._refuse_other_settings(self.out / SETTINGS_FILE)
        training, data = settings.training, settings.data
        if self.minutes is not None:
            training = replace(training, minutes=self.minutes)
        if self.seed is not None:
            training, data = replace(training, seed=self.seed), replace(data, seed=self.seed)
        return NetworkSettings(training, data)

    def _refuse_other_settings(self, file: Path) -> None:
        from unicon.errors import UniconError

        default = NetworkSettings()
        for group in fields(default):
            mine, usual = getattr(self.settings, group.name), getattr(default, group.name)
            for item in fields(usual):
                if getattr(mine, item.name) != getattr(usual, item.name):
                    option = f"--{group.name}.{item.name}".replace("_", "-")
                    raise UniconError(f"--resume goes on with the settings of {file}; leave out {option}")

    def _prepare(self, settings: NetworkSettings, console: Console) -> NetworkTrainingRun:
        """Make the data and bring a trainer to where the run stands."""
        from unicon.motion.store.library import ClipLibrary
        from unicon.train.learning.compute import use_threads
        from unicon.train.pfnn.data_report import write_report
        from unicon.train.pfnn.network_facts import card_of_data, training_in_words
        from unicon.train.pfnn.settings_file import save_settings
        from unicon.train.pfnn.training import NetworkError, NetworkTrainer
        from unicon.train.pfnn.training_data import make_training_data
        from unicon.train.pfnn.training_run import NetworkTrainingRun

        use_threads(0)
        library = ClipLibrary(self.library)
        save_settings(self.out, settings, self.resume)
        data = make_training_data(library, settings.data, console)
        trainer = NetworkTrainer(data, settings.training)
        learned, held_out = trainer.samples
        console.print(f"{learned} samples to learn from, {held_out} held out", highlight=False)
        base = card_of_data(self.out.resolve().name, data, library.infos, settings.training.seed)

        def describe(error: NetworkError, seconds: float) -> PhaseNetworkCard:
            words = training_in_words(settings.training, trainer.steps, seconds)
            return replace(base, training=words, held_out_error={**error.parts, "loss": error.loss})

        run = NetworkTrainingRun(trainer, self.out, console, describe)
        with console.status("measuring the data"):
            write_report(run.network_folder, data)
        return run


@dataclass(frozen=True)
class PfnnConvert:
    """Convert the weights that the authors of the paper published into a safetensors file.

    For people who have them: a folder with W0_000.bin to b2_049.bin, Xmean.bin, Xstd.bin, Ymean.bin and
    Ystd.bin. The network runs with `PhaseNetwork.predict`, but it is for a body of 31 joints and another
    layout of input and output: the keyboard scheduler cannot drive our humanoid with it, and refuses it.
    """

    folder: Annotated[Path, tyro.conf.Positional]
    """Where the files are."""
    out: Path
    """File to write, *.safetensors; its card is written beside it as *.json."""

    def run(self, console: Console) -> int:
        """Write the file and print where it is."""
        from unicon.errors import UniconError
        from unicon.schedulers.pfnn.network_file import save_network
        from unicon.train.pfnn.original_weights import original_card, read_original

        if self.out.suffix != ".safetensors":
            raise UniconError(f"--out is {self.out}, expected a file *.safetensors")
        card = save_network(self.out, original_card(self.out.stem), read_original(self.folder))
        console.print(f"{self.out}: {card.layout_id}, not for our humanoid", soft_wrap=True, highlight=False)
        return 0
