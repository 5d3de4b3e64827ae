import io

import numpy as np
import pytest
import tyro
from rich.console import Console

from tests.train.pfnn.toy_gait import make_toy_data
from tests.train.small_library import make_library
from unicon.errors import InputFileError, UniconError
from unicon.schedulers.pfnn.network_file import read_network
from unicon.train.pfnn import original_weights, training_data
from unicon.train.pfnn.original_weights import ORIGINAL_LAYOUT, ORIGINAL_SIZES
from unicon.train.pfnn.settings_file import open_settings
from unicon.train.pfnn_commands import NetworkSettings, PfnnConvert, PfnnTrain

SMALL = ("--training.hidden", "8", "--training.minibatch", "16", "--training.minutes", "0")


@pytest.fixture
def library(tmp_path, monkeypatch):
    """The library of a few clips; a toy gait stands for what is made of them."""
    monkeypatch.setattr(training_data, "make_training_data", lambda *_: make_toy_data(takes=3, frames=60))
    return make_library(tmp_path / "library").folder


def _train(library, out, *words):
    """Run the command as from a terminal; return what it printed."""
    console = Console(file=io.StringIO(), width=200)
    command = tyro.cli(PfnnTrain, args=["--library", str(library), "--out", str(out), *words])
    assert command.run(console) == 0
    return console.file.getvalue()


def test_a_run_saves_its_settings_and_can_be_gone_on_with(library, tmp_path):
    out = tmp_path / "walk"
    printed = _train(library, out, "--seed", "3", *SMALL, "--training.steps", "20")
    assert "120 samples to learn from, 60 held out" in printed
    assert "finished after 20 steps" in printed
    assert f"min; the network is in {out / 'pfnn'}" in printed
    settings = open_settings(out, NetworkSettings)
    assert (settings.training.seed, settings.training.hidden, settings.training.steps) == (3, 8, 20)
    assert settings.data.seed == 3
    card, _ = read_network(out / "pfnn" / "pfnn.safetensors")
    assert (card.name, card.seed, card.sizes) == ("walk", 3, (305, 8, 8, 109))
    assert card.training.startswith("0.00 M samples in 20 steps of 16")
    with pytest.raises(UniconError, match="holds a run already; go on with it by --resume"):
        _train(library, out)
    assert "finished after 20 steps" in _train(library, out, "--resume")
    assert "finished after" in _train(library, out, "--resume", "--minutes", "0.001")


def test_a_resumed_run_takes_no_other_settings(library, tmp_path):
    out = tmp_path / "walk"
    _train(library, out, *SMALL, "--training.steps", "5")
    with pytest.raises(UniconError, match=r"config.yaml; leave out --training.pose-noise"):
        _train(library, out, "--resume", "--training.pose-noise", "0.7")
    with pytest.raises(InputFileError, match=r"config.yaml: cannot be read \(No such file"):
        _train(library, tmp_path / "nowhere", "--resume")


def test_ctrl_c_ends_with_the_command_to_go_on(library, tmp_path, monkeypatch):
    monkeypatch.setattr("unicon.train.pfnn.training_run.NetworkTrainingRun.train", lambda _: "stopped")
    printed = _train(library, tmp_path / "walk", *SMALL)
    assert "stopped after 0 steps, 0.0 min; go on with: unicon pfnn train --library" in printed
    assert printed.rstrip().endswith("--resume")


def test_a_setting_that_is_none_is_told_with_its_file(library, tmp_path):
    (tmp_path / "config.yaml").write_text("training: {droput: 0.1}")
    with pytest.raises(InputFileError, match=r"no setting training.droput; did you mean dropout\?"):
        open_settings(tmp_path, NetworkSettings)


def _convert(*words):
    console = Console(file=io.StringIO(), width=200)
    status = tyro.cli(PfnnConvert, args=list(words)).run(console)
    return status, console.file.getvalue()


def test_the_original_weights_are_converted(tmp_path, monkeypatch):
    sizes = ORIGINAL_SIZES
    monkeypatch.setattr(original_weights, "PRECOMPUTED_PHASES", 2)
    shapes = {f"{name}{part}": (size,) for name, size in (("X", 342), ("Y", 311)) for part in ("mean", "std")}
    for phase in range(2):
        for index in range(3):
            shapes[f"W{index}_{phase:03d}"] = (sizes[index + 1], sizes[index])
            shapes[f"b{index}_{phase:03d}"] = (sizes[index + 1],)
    for name, shape in shapes.items():
        np.full(shape, 0.01, "<f4").tofile(tmp_path / f"{name}.bin")
    out = tmp_path / "theirs.safetensors"
    status, printed = _convert(str(tmp_path), "--out", str(out))
    assert (status, printed) == (0, f"{out}: {ORIGINAL_LAYOUT}, not for our humanoid\n")
    card, network = read_network(out, None)
    assert (card.name, network.phases, network.predict(np.zeros(342), 1.0).shape) == ("theirs", 2, (311,))
    with pytest.raises(UniconError, match="for the layout"):
        read_network(out)
    with pytest.raises(UniconError, match=r"expected a file \*.safetensors"):
        _convert(str(tmp_path), "--out", str(tmp_path / "theirs.bin"))


def test_help_says_that_converted_weights_do_not_drive_our_humanoid(capsys):
    with pytest.raises(SystemExit):
        _convert("--help")
    assert "cannot drive our humanoid" in " ".join(capsys.readouterr().out.replace("│", " ").split())
