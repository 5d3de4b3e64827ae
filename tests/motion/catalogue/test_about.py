import pytest

from unicon.motion.catalogue.about import describe, words


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("JumpTurn180", "jump turn 180"),
        ("dataset-1_walk-left_angry_003", "dataset 1 walk left angry 003"),
        ("run/jog, veer right", "run jog veer right"),
        ("TRexWalk", "t rex walk"),
        ("", ""),
    ],
)
def test_words_are_taken_apart(text, expected):
    assert words(text) == expected


def test_a_cmu_take_is_described_by_its_index():
    about = describe("cmu_amc.zip/49/49_18.amc")
    assert about.description == "balance on one leg, outstretched arms"
    assert about.context == "modern dance, gymnastics"
    assert about.key == "cmu/49_18"


def test_a_description_that_says_nothing_is_left_out():
    assert describe("cmu/94_01.bvh").description == ""


def test_any_other_file_is_described_by_its_name_and_folders():
    about = describe("a/b/studio/day_1/Sword_Attack_RM.bvh", label="martial")
    assert (about.description, about.context, about.label) == ("Sword_Attack", "studio day_1", "martial")
