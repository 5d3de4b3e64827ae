"""Tests for training_data.py, manoeuvres.py and takes.py."""

from __future__ import annotations

import numpy as np
import pytest
from rich.console import Console

from tests.train.pfnn.walking_samples import walker
from unicon.errors import InputFileError, UniconError
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.motion.store.library_writer import LibraryWriter
from unicon.schedulers.pfnn.layout import INPUT_SIZE, OUTPUT_SIZE, unpack_input, unpack_output
from unicon.train.pfnn.manoeuvres import ManoeuvreMaker
from unicon.train.pfnn.synthesis import plant, sequence
from unicon.train.pfnn.takes import read_takes
from unicon.train.pfnn.training_data import TrainingDataConfig, make_training_data, mirror, samples_of

QUIET = Console(quiet=True)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """Two of the clips of the table: one that stands and one that walks."""
    folder = tmp_path_factory.mktemp("library")
    with LibraryWriter(folder) as writer:
        for clip in (walker("010_acted", 14.0, 0.0, step=0.0), walker("07_01", 2.5)):
            writer.add(ClipInfo(clip.name, len(clip), "walking"), clip.frames)
        writer.commit()
    return ClipLibrary(folder)


@pytest.fixture(scope="module")
def data(library):
    return make_training_data(library, TrainingDataConfig(held_out=("010_acted",)), QUIET)


def test_samples_have_the_layout_and_are_finite(data):
    count = len(data.phases)
    assert data.inputs.shape == (count, INPUT_SIZE)
    assert data.outputs.shape == (count, OUTPUT_SIZE)
    assert data.inputs.dtype == data.outputs.dtype == np.float32
    assert np.isfinite(data.inputs).all() and np.isfinite(data.outputs).all()
    assert data.phases.min() >= 0.0 and data.phases.max() < 2 * np.pi
    assert np.all(np.diff(data.sequences) >= 0)


def test_takes_are_bent_reversed_mirrored_and_held_out_by_clip(data):
    assert {"standing", "walking", "backward", "sideways"} == set(data.kinds)
    assert any("aside +40" in name for name in data.names)
    assert any("bent +50" in name for name in data.names)
    assert any("reversed" in name and name.endswith("mirrored") for name in data.names)
    held = {data.names[index] for index in np.unique(data.sequences[data.held_out])}
    assert held == {"010_acted", "010_acted mirrored"}


def test_an_answer_is_the_next_frame_of_the_take():
    planted = plant(sequence([walker("walk", 4.0).frames], []))
    samples = samples_of(planted)
    frames, at = planted.frames, 100
    answer = unpack_output(samples.outputs[at].astype(np.float64))
    assert np.allclose(answer["joint_pos"], frames.joint_pos[at + 1], atol=1e-6)
    assert answer["root_height"][0] == pytest.approx(frames.root_pos_w[at + 1, 2], abs=1e-6)
    assert answer["root_vel_h"][0] == pytest.approx(1.0, abs=1e-4)
    # the path ahead of the next frame is that of the next input
    following = unpack_input(samples.inputs[at + 1].astype(np.float64))
    assert np.allclose(answer["path_pos_h"], following["path_pos_h"][6:], atol=1e-6)


def test_a_mirrored_walker_turns_the_other_way_and_is_half_a_cycle_on():
    planted = plant(sequence([walker("walk", 6.0).frames], []))
    ours, theirs = samples_of(planted), samples_of(mirror(planted))
    here, there = (unpack_output(samples.outputs) for samples in (ours, theirs))
    assert np.allclose(here["turn_rate"], -there["turn_rate"], atol=1e-5)
    assert np.allclose(here["root_vel_h"] * [1, -1], there["root_vel_h"], atol=1e-5)
    off = np.remainder(ours.phases - theirs.phases, 2 * np.pi)[120:240]
    assert np.allclose(off, np.pi, atol=1e-3)


def test_a_library_without_locomotion_is_refused(tmp_path):
    with LibraryWriter(tmp_path) as writer:
        clip = walker("other", 1.0)
        writer.add(ClipInfo("other", len(clip), "walking"), clip.frames)
        writer.commit()
    with pytest.raises(UniconError, match="none of the standing and walking clips"):
        make_training_data(ClipLibrary(tmp_path), TrainingDataConfig(), QUIET)


def test_the_shipped_table_can_be_read_and_a_wrong_one_is_named(tmp_path):
    assert any(entry.loop for entry in read_takes().walking)
    path = tmp_path / "takes.yaml"
    path.write_text("standing: []\nwalkin: []\n")
    with pytest.raises(
        InputFileError, match=r"takes\.yaml: there is no setting walkin; did you mean walking"
    ):
        read_takes(path)


def test_clips_that_are_held_out_are_in_no_take_of_another(tmp_path):
    with LibraryWriter(tmp_path) as writer:
        standing, run = walker("010_acted", 14.0, 0.0, step=0.0), walker("jog", 2.5, 2.5)
        for clip in (standing, walker("07_01", 2.5), walker("07_06", 2.5, 0.8, step=0.2), run):
            writer.add(ClipInfo(clip.name, len(clip), "walking"), clip.frames)
        writer.commit()
    library = ClipLibrary(tmp_path)
    for held_out, others in (((), 2), (("07_06",), 1)):
        maker = ManoeuvreMaker(read_takes(), library, 0, held_out)
        runs = [part for m in maker.all() if m.kind == "running" for part in m.parts[1:-1]]
        assert (
            len({float(part.joint_pos[5:30].std()) for part in runs if part.root_lin_vel_w[5, 0] < 1.5})
            == others
        )
