import pytest

from unicon.motion.catalogue.takes import plain_name, take_of


@pytest.mark.parametrize(
    "origin",
    [
        "cmu_amc.zip/49/49_08.amc",
        "cmu_fbx.zip/bvh/49_08.bvh",
        "cmu_deepmimic.zip/49_08.txt",
        "somewhere/49_08_mirrored.bvh",
        "amp_humanoid_npz.zip/amp_humanoid_cartwheel.npz",
    ],
)
def test_all_formats_of_a_cmu_take_share_it(origin):
    assert take_of(origin) == "cmu/49_08"


def test_two_trials_are_two_takes():
    assert take_of("cmu/07_01.bvh") != take_of("cmu/07_02.bvh")


def test_deepmimic_in_the_wheel_is_deepmimic_in_the_repository():
    wheel = "pybullet.whl/pybullet_data/data/motions"
    assert take_of(f"{wheel}/humanoid3d_kick.txt") == take_of("deepmimic.zip/kick.txt")
    assert take_of(f"{wheel}/walker/turn_left0.txt") == take_of("deepmimic.zip/long_walk1.txt")


def test_a_cut_shares_the_take_of_the_whole():
    assert take_of("deepmimic.zip/zombie_walk.txt") == take_of("deepmimic.zip/long_zombie.txt")
    assert take_of("deepmimic.zip/jump_run_roll.txt") == take_of("cmu_deepmimic.zip/127_23.txt")


def test_mirrored_sets_share_takes():
    pair = ("deepmimic_sie.zip/run_left00.txt", "deepmimic_sie.zip/run_right07.txt")
    assert take_of(pair[0]) == take_of(pair[1])
    assert take_of(pair[0]) != take_of("deepmimic_sie.zip/run_right00.txt")


def test_partners_of_one_dance_share_the_take():
    assert take_of("cmu_daz_bvh.zip/61_04.bvh") == "cmu/60_04"


def test_a_cleaned_version_shares_the_take_of_the_raw_one():
    assert take_of("cmu/78_02.bvh") == take_of("cmu/102_01.bvh")


def test_a_clip_with_root_motion_is_the_take_of_the_one_in_place():
    folder = "cc0_keyframed_bvh.zip/quaternius"
    assert take_of(f"{folder}/Roll_RM.bvh") == take_of(f"{folder}/Roll.bvh") == "quaternius/roll"


def test_unknown_files_of_one_name_in_two_folders_are_two_takes():
    assert take_of("studio/day_1/jump.bvh") != take_of("studio/day_2/jump.bvh")
    assert take_of("studio/day_1/jump.bvh") == take_of("studio/day_1/jump_mirrored.bvh")


def test_all_marks_of_a_copy_fall_off_a_name():
    assert plain_name("humanoid3d_Kick_RM_mirrored") == "Kick"
    assert plain_name("mirror") == "mirror"
