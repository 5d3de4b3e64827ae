import pytest

from unicon.motion.catalogue.cmu_index import cmu_index, cmu_take


def test_the_index_holds_the_published_takes():
    assert len(cmu_index()) > 2400
    walk = cmu_index()[7, 1]
    assert (walk.name, walk.description, walk.subject_description, walk.rate_hz) == (
        "07_01",
        "walk",
        "walk",
        120.0,
    )


def test_salsa_was_captured_at_60_hz():
    assert cmu_index()[60, 1].rate_hz == 60.0


@pytest.mark.parametrize("stem", ["07_01", "7_1", "CMU_07_01", "07_01_cmu", "07_01_mirrored", "07_01_poses"])
def test_all_names_of_a_take_are_known(stem):
    take = cmu_take(stem)
    assert take is not None
    assert take.name == "07_01"


@pytest.mark.parametrize(
    "stem", ["001_acted", "05-run", "train_running_1", "999_01", "07_99", "walk", "07_01_02"]
)
def test_other_names_mean_no_take(stem):
    assert cmu_take(stem) is None
