import re

import pytest

from unicon.motion.catalogue.about import describe
from unicon.motion.catalogue.classes import OTHER, classify, classify_words, known_classes, normalize
from unicon.motion.catalogue.cmu_index import cmu_index

BANDAI = "bandai_namco_bvh.zip/dataset-1/dataset-1"


@pytest.mark.parametrize(
    ("origin", "expected"),
    [
        ("cmu_mb_bvh.zip/02_01.bvh", "walking/forward"),
        ("cmu_iclone_bvh.zip/06_01.bvh", "walking/forward"),
        ("cmu_iclone_bvh.zip/06_06.bvh", "sport/basketball"),
        ("cmu_iclone_bvh.zip/05_06.bvh", "dance/ballet"),
        ("cmu_daz_bvh.zip/60_01.bvh", "dance/salsa"),
        ("cmu_daz_bvh.zip/94_04.bvh", "dance/indian"),
        ("cmu_daz_bvh.zip/135_08.bvh", "casual/calibration"),
        ("cmu_deepmimic.zip/16_52.txt", "running/turn"),
        ("cmu_deepmimic.zip/127_26.txt", "jumping/running"),
        ("cmu_deepmimic.zip/90_05.txt", "martial/kick"),
        ("cmu_deepmimic.zip/10_05.txt", "sport/soccer"),
        ("cmu_deepmimic.zip/140_01.txt", "ground/getting_up"),
        ("cmu_fbx.zip/bvh/91_54.bvh", "jumping/turn"),
        ("cmu_max_bvh.zip/131_01.bvh", "special_style/michael_jackson"),
        ("cmu_mb_bvh.zip/dmgnn/train_directing_traffic_1.bvh", "casual/signal"),
        ("deepmimic.zip/long_zombie.txt", "special_style/zombie"),
        ("deepmimic.zip/pybullet_walker_turn_left0.txt", "walking/turn"),
        ("deepmimic.zip/jump_bridge.txt", "acrobatics/on_hands"),
        ("reactidle_bvh.zip/acted/001_acted.bvh", "casual/idle"),
        ("cc0_keyframed_bvh.zip/mesh2motion/Crawl_RM.bvh", "animal/crawling"),
        ("cc0_keyframed_bvh.zip/quaternius/Sword_Idle.bvh", "martial/stance"),
        ("ase_reallusion_npz.zip/RunLeft.npz", "running/sideways"),
        ("ase_reallusion_npz.zip/Shield_BlockLeft.npz", "martial/block"),
        ("pfnn_bvh.zip/LocomotionFlat04_000.bvh", "walking/wander"),
        (f"{BANDAI}_walk-left_angry_003.bvh", "walking/sideways/aggressive"),
        (f"{BANDAI}_walk-back_old_001.bvh", "walking/backward/weary"),
        (f"{BANDAI}_walk-turn-left_normal_001.bvh", "walking/turn"),
        (f"{BANDAI}_bow_angry_001.bvh", "casual/greeting"),
    ],
)
def test_words_tell_the_class(origin, expected):
    assert classify(describe(origin)) == expected


def test_the_context_decides_where_the_words_say_nothing():
    assert classify_words("Unknown thing", "Walking with obstacles") == "walking/obstacles"
    assert classify_words("Swing", "golf") == "sport/golf"


def test_animals_of_stylized_walks_are_characters():
    assert classify_words("Cat Walk", "Stylized Motions") == "special_style/character"
    assert classify_words("cat (human subject)", "animal behaviors") == "animal/four_legs"


def test_words_that_no_rule_knows_end_in_other():
    assert classify_words("qwertz", "asdf") == OTHER


def test_a_label_that_is_a_path_stands():
    assert (
        classify(describe("cmu/02_01.bvh", label="Walking/Forward/Very Slow")) == "walking/forward/very_slow"
    )


def test_a_label_in_words_goes_through_the_rules():
    assert classify(describe("cmu/02_01.bvh", label="cartwheel")) == "acrobatics/cartwheel"


def test_a_label_that_no_rule_knows_is_a_class_of_its_own():
    assert classify(describe("x.bvh", label="Juggling")) == "juggling"


def test_a_label_of_the_top_of_the_tree_stands():
    assert classify(describe("x.bvh", label="dance")) == "dance"


def test_normalize_drops_spaces_and_empty_parts():
    assert normalize(" Dance//Hip-Hop /") == "dance/hip_hop"
    assert normalize("/") == OTHER


def test_classes_are_written_alike():
    assert all(re.fullmatch(r"[a-z_]+(/[a-z_]+)*", path) for path in known_classes())


def test_of_the_cmu_index_at_most_five_percent_end_in_other():
    labels = [classify(describe(f"cmu/{take.name}.amc")) for take in cmu_index().values()]
    assert labels.count(OTHER) <= 0.05 * len(labels)
