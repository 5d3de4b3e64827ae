import numpy as np
import pytest

from unicon.errors import InputFileError
from unicon.schedulers.pfnn.layout import LAYOUT_ID
from unicon.schedulers.pfnn.network_file import read_network, save_network
from unicon.train.pfnn import original_weights
from unicon.train.pfnn.original_weights import original_card, read_original

SIZES = (342, 512, 512, 311)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Files of the published names and lengths, but of 5 phases, as 50 have 120 MB."""
    monkeypatch.setattr(original_weights, "PRECOMPUTED_PHASES", 5)
    rng = np.random.default_rng(0)
    folder = tmp_path / "weights"
    folder.mkdir()

    def write(name, *shape):
        rng.uniform(0.01, 0.05, shape).astype("<f4").tofile(folder / f"{name}.bin")

    for phase in range(5):
        for index in range(3):
            write(f"W{index}_{phase:03d}", SIZES[index + 1], SIZES[index])
            write(f"b{index}_{phase:03d}", SIZES[index + 1])
    for name, size in (("Xmean", 342), ("Xstd", 342), ("Ymean", 311), ("Ystd", 311)):
        write(name, size)
    return folder


def _read(folder, name, *shape):
    return np.fromfile(folder / f"{name}.bin", "<f4").reshape(shape).astype(float)


def test_the_network_says_what_its_files_do(folder):
    network = read_original(folder)
    assert (network.sizes, network.phases) == (SIZES, 5)
    x = np.linspace(-0.1, 0.1, 342)
    h = (x - _read(folder, "Xmean", 342)) / _read(folder, "Xstd", 342)
    for index in range(3):
        weight = _read(folder, f"W{index}_002", SIZES[index + 1], SIZES[index])
        h = weight @ h + _read(folder, f"b{index}_002", SIZES[index + 1])
        h = np.where(h > 0, h, np.expm1(h)) if index < 2 else h
    expected = h * _read(folder, "Ystd", 311) + _read(folder, "Ymean", 311)
    assert network.predict(x, 2 * np.pi * 2 / 5) == pytest.approx(expected, rel=1e-4)


def test_it_survives_the_way_through_our_file(folder, tmp_path):
    network = read_original(folder)
    path = tmp_path / "theirs.safetensors"
    save_network(path, original_card("theirs"), network)
    card, back = read_network(path, None)
    assert card.layout_id == "holden-2017-31-joints" != LAYOUT_ID
    assert np.array_equal(back.predict(np.ones(342), 1.0), network.predict(np.ones(342), 1.0))


def test_a_truncated_file_is_named_with_its_length(folder):
    file = folder / "W1_003.bin"
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(InputFileError, match=r"W1_003.bin: has 1048536 bytes, expected 1048576 \(512 x 512"):
        read_original(folder)


def test_a_file_or_folder_that_is_missing_is_named(folder, tmp_path):
    with pytest.raises(InputFileError, match="there is no such folder"):
        read_original(tmp_path / "nowhere")
    (folder / "Ymean.bin").unlink()
    with pytest.raises(InputFileError, match=r"Ymean.bin: cannot be read \(No such file"):
        read_original(folder)


def test_numbers_that_cannot_be_are_refused(folder):
    np.zeros(342, "<f4").tofile(folder / "Xstd.bin")
    with pytest.raises(InputFileError, match="Xstd.bin: holds 0, expected deviations above 0"):
        read_original(folder)
    np.full(512, np.nan, "<f4").tofile(folder / "b0_004.bin")
    with pytest.raises(InputFileError, match="b0_004.bin: holds a number that is not finite"):
        read_original(folder)
