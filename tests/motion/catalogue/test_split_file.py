import pytest

from unicon.errors import InputFileError
from unicon.motion.catalogue.split import SplitPlan, SplitSettings, split_clips
from unicon.motion.catalogue.split_file import apply_split, read_split, write_split
from unicon.motion.clip_index import ClipInfo

GOOD = """version: 1
settings: {test_share: 0.2, seed: 0}
clips:
  walk: train
  hop: test
"""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "split.yaml"


def test_a_split_written_and_read_back_is_the_same(path):
    names = ["walk", "null", "1e3", "a: b", "07_01", "yes", "ünïcode", "x" * 300]
    plan = split_clips([ClipInfo(name, 100, "walking") for name in names], SplitSettings(0.3, 7))
    write_split(plan, path)
    assert read_split(path) == plan


def test_a_hand_written_split_is_read(path):
    path.write_text(GOOD)
    assert read_split(path) == SplitPlan(SplitSettings(0.2, 0), {"walk": "train", "hop": "test"})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("hop: test", "hop: tset", "line 5: clip 'hop' is 'tset', expected train or test"),
        ("hop: test", "walk: test", "line 5: 'walk' stands there twice"),
        ("hop: test", "hop: [test]", "line 5: clip 'hop' is ''"),
        ("version: 1", "version: 2", "has version 2, expected 1"),
        ("seed: 0", "seed: many", "line 2: expected numbers test_share and seed"),
        ("test_share: 0.2", "test_share: 2", "line 2: the test_share of a split"),
        ("settings: {test_share: 0.2, seed: 0}\n", "", "'settings' holds no entries"),
        ("clips:\n", "clips: [\n", "is not YAML"),
    ],
)
def test_a_bad_split_is_refused_with_its_line(path, old, new, message):
    path.write_text(GOOD.replace(old, new))
    with pytest.raises(InputFileError, match=message.replace("[", r"\[")) as caught:
        read_split(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["", "- a\n", "walk\n"])
def test_what_is_no_split_is_refused(path, text):
    path.write_text(text)
    with pytest.raises(InputFileError, match="line 1: the file holds no entries"):
        read_split(path)


def test_a_missing_split_is_said(path):
    with pytest.raises(InputFileError, match="cannot be read"):
        read_split(path)


def test_a_folder_that_is_not_there_is_said(tmp_path):
    with pytest.raises(InputFileError, match="cannot be written"):
        write_split(SplitPlan(SplitSettings(), {}), tmp_path / "no" / "split.yaml")


def test_sides_are_given_to_the_rows(path):
    path.write_text(GOOD)
    rows = apply_split([ClipInfo("hop", 60), ClipInfo("walk", 60)], read_split(path), path)
    assert [info.split for info in rows] == ["test", "train"]


def test_a_clip_that_the_split_lacks_is_named(path):
    path.write_text(GOOD)
    with pytest.raises(InputFileError, match=r"lacks the clip 'walks' \(the nearest there is 'walk'\)"):
        apply_split([ClipInfo("walks", 60)], read_split(path), path)


def test_copies_of_one_take_on_two_sides_are_refused(path):
    path.write_text(GOOD)
    rows = [ClipInfo("walk", 60, take="t"), ClipInfo("hop", 60, take="t")]
    with pytest.raises(InputFileError, match="'hop' is test but 'walk', the same take 't', is train"):
        apply_split(rows, read_split(path), path)
