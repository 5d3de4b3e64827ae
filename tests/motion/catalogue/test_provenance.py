import pytest

from unicon.motion.catalogue.provenance import UNKNOWN_LICENCE, provenance_of


@pytest.mark.parametrize(
    ("origin", "collection", "licence"),
    [
        ("data/cmu_amc.zip/07/07_05.amc", "cmu", "CMU database"),
        ("cache/cmu/subjects/07/07_05.amc", "cmu", "CMU database"),
        ("cmu_deepmimic.zip/02_01.txt", "cmu", "retargeted files MIT"),
        ("deepmimic.zip/walk.txt", "deepmimic", "MIT"),
        ("deepmimic.zip/pybullet_walker_turn_left0.txt", "deepmimic", "Zlib"),
        ("pybullet-3.2.7.whl/pybullet_data/data/motions/humanoid3d_walk.txt", "deepmimic", "Zlib"),
        ("deepmimic_sie.zip/run_left00.txt", "deepmimic_sie", "CC-BY-NC-4.0"),
        ("cc0_keyframed_bvh.zip/quaternius/Walk_Loop.bvh", "quaternius", "CC0-1.0"),
        ("cc0_keyframed_bvh.zip/mesh2motion/Bow.bvh", "mesh2motion", "CC0-1.0"),
        ("bandai_namco_bvh.zip/dataset-1/dataset-1_bow_active_001.bvh", "bandai_namco", "CC-BY-NC-4.0"),
    ],
)
def test_the_folder_tells_collection_and_licence(origin, collection, licence):
    found = provenance_of(origin)
    assert found.collection == collection
    assert licence in found.licence


def test_cmu_data_carries_its_credit_line():
    assert provenance_of("cmu_amc.zip/07/07_05.amc").credit == (
        "The data used in this project was obtained from mocap.cs.cmu.edu. "
        "The database was created with funding from NSF EIA-0196217."
    )


def test_what_is_not_for_commerce_is_not_shippable():
    assert provenance_of("cmu_amc.zip/07/07_05.amc").shippable
    assert not provenance_of("pfnn_bvh.zip/LocomotionFlat04_000.bvh").shippable


def test_an_unknown_file_has_its_folder_as_source_and_no_licence():
    found = provenance_of("home/me/studio/day_1/jump.bvh")
    assert (found.source, found.licence, found.shippable) == ("home/me/studio/day_1", UNKNOWN_LICENCE, False)
    assert found.collection == "studio/day_1"


def test_a_person_says_source_and_licence():
    found = provenance_of("studio/jump.bvh", source="Our studio", licence="CC0-1.0")
    assert (found.source, found.licence) == ("Our studio", "CC0-1.0")


def test_a_folder_far_above_says_nothing():
    assert provenance_of("cmu/a/b/c/d/jump.bvh").licence == UNKNOWN_LICENCE


def test_the_innermost_folder_decides():
    assert provenance_of("cmu/deepmimic/walk.txt").collection == "deepmimic"


def test_part_of_a_word_is_no_collection():
    assert provenance_of("acmuseum/jump.bvh").licence == UNKNOWN_LICENCE
