"""Tests for network_file.py and network_card.py: a network from disk, and refusals."""

import json

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from tests.schedulers.pfnn.small_network import make_network
from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.humanoid import HUMANOID
from unicon.policy_file import PolicyMismatchError
from unicon.schedulers.pfnn.layout import GAITS, INPUT_SIZE, LAYOUT_ID, OUTPUT_SIZE
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
from unicon.schedulers.pfnn.network_file import card_file, find_network, read_network, save_network

CARD = PhaseNetworkCard(
    name="small",
    description="random numbers",
    layout_id=LAYOUT_ID,
    humanoid_id=HUMANOID.id,
    gaits=GAITS,
    training_data=("nothing (public domain): 0 min",),
    takes=("a", "b"),
    limits={"forward_m_s": 1.5, "turn_rad_s": 2},
    gait_speeds_m_s={"walk": (0.8, 1.2, 1.6)},
    held_out_error={"loss": 0.5},
    seed=3,
)


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "small" / "pfnn.safetensors"
    save_network(path, CARD, make_network((INPUT_SIZE, 8, 8, OUTPUT_SIZE)))
    return path


def _edit_card(path, **changes):
    file = card_file(path)
    file.write_text(json.dumps({**json.loads(file.read_text()), **changes}))


def _edit_tensors(path, change):
    tensors = load_file(path)
    change(tensors)
    save_file(tensors, path)


def test_a_network_comes_back_to_the_bit(path):
    card, network = read_network(path)
    x = np.linspace(-1, 1, INPUT_SIZE)
    assert np.array_equal(
        network.predict(x, 0.7), make_network((INPUT_SIZE, 8, 8, OUTPUT_SIZE)).predict(x, 0.7)
    )
    assert (card.sizes, card.phases, card.interpolation) == ((INPUT_SIZE, 8, 8, OUTPUT_SIZE), 4, "cubic")
    assert (card.limits, card.gait_speeds_m_s) == (CARD.limits, CARD.gait_speeds_m_s)
    assert (card.gaits, card.takes, card.training_data) == (GAITS, CARD.takes, CARD.training_data)
    assert sorted(file.name for file in path.parent.iterdir()) == ["pfnn.json", "pfnn.safetensors"]


def test_a_network_is_found_by_its_name_and_by_its_path(path, monkeypatch):
    monkeypatch.setenv("UNICON_POLICIES", str(path.parents[1]))
    assert find_network("small") == find_network(str(path.parent)) == find_network(str(path)) == path
    with pytest.raises(UnknownNameError, match=r"'smal' .*there are small"):
        find_network("smal")


def test_another_layout_and_another_body_are_refused_unless_asked_for(path):
    _edit_card(path, layout_id="other")
    with pytest.raises(PolicyMismatchError, match=f"the layout other, this program has {LAYOUT_ID}"):
        read_network(path)
    assert read_network(path, None)[0].layout_id == "other"
    _edit_card(path, layout_id=LAYOUT_ID, humanoid_id="")
    with pytest.raises(PolicyMismatchError, match="the humanoid of another body"):
        read_network(path)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"seed": "three"}, "'seed' is a str, expected int"),
        ({"takes": "a"}, "'takes' is a str, expected list"),
        ({"takes": [1]}, "'takes' holds 1, expected texts"),
        ({"limits": {"forward_m_s": "fast"}}, "'limits' holds 'fast', expected numbers"),
        ({"gait_speeds_m_s": {"walk": [1.0]}}, "expected three speeds for each gait"),
        ({"gait_speeds_m_s": {"walk": [1.0, 2.0, None]}}, "'gait_speeds_m_s' holds None, expected numbers"),
        ({"interpolation": "square"}, "'interpolation' is 'square', expected one of"),
        ({"format": 2}, "has the format 2, this program reads 1"),
        ({"colour": "red"}, "unknown field 'colour'"),
        ({"phases": 50}, "its card says .* at 50"),
        ({"self_check": [0.0]}, "not one number for each output"),
        ({"self_check": [0.0] * OUTPUT_SIZE}, "do not belong together"),
    ],
)
def test_a_card_that_says_something_else_is_refused_with_the_field(path, changes, message):
    _edit_card(path, **changes)
    with pytest.raises(InputFileError, match=message):
        read_network(path)


def test_a_card_that_is_no_card_is_refused(path):
    file = card_file(path)
    for text, message in (
        ("[]", "expected a JSON object"),
        ("{", "is not JSON"),
        ("{}", "'name' is missing"),
    ):
        file.write_text(text)
        with pytest.raises(InputFileError, match=message):
            read_network(path)
    file.unlink()
    with pytest.raises(InputFileError, match=r"pfnn.json: cannot be read \(No such file"):
        read_network(path)


def _drop(tensors):
    del tensors["layers.1.bias"]


def _spoil(tensors):
    tensors["layers.0.weight"][0, 0, 0] = np.nan


def _shorten(tensors):
    tensors["output.mean"] = tensors["output.mean"][1:]


def _unchain(tensors):
    tensors["layers.1.weight"] = tensors["layers.1.weight"][:, :, 1:]


def _flatten(tensors):
    tensors["input.std"][3] = 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_drop, "the tensor 'layers.1.bias' is missing"),
        (_spoil, "not finite"),
        (_shorten, "do not follow on each other"),
        (_unchain, "do not follow on each other"),
        (_flatten, "is not above 0"),
    ],
)
def test_damaged_weights_are_refused(path, change, message):
    _edit_tensors(path, change)
    with pytest.raises(InputFileError, match=message):
        read_network(path)


def test_a_truncated_file_is_refused(path):
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(InputFileError, match="cannot be read as safetensors"):
        read_network(path)


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UniconError, match="the network cannot be written"):
        save_network(tmp_path / "file" / "pfnn.safetensors", CARD, make_network())
