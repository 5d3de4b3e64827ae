import random

import pytest
import yaml

from unicon.errors import InputFileError
from unicon.motion.clip_index import ClipInfo
from unicon.train.specialists.clusters import (
    Cluster,
    folder_name,
    make_clusters,
    read_clusters,
    single_cluster,
    write_clusters,
)


def _infos(label: str, *frames: int) -> list[ClipInfo]:
    return [ClipInfo(f"{label.replace('/', '_')}{count}", count, label) for count in frames]


INFOS = [
    *_infos("walking/forward", 50, 300, 60, 280, 55, 310, 65),
    *_infos("walking/wander", 100),
    *_infos("walking/crouched", 90),
    *_infos("ground/falling", 40),
    *_infos("ground/getting_up", 70),
    *_infos("sport", 44),
]


def _as_sets(clusters: list[Cluster]) -> dict[str, set[str]]:
    return {cluster.name: set(cluster.clips) for cluster in clusters}


def test_classes_become_clusters_and_large_ones_are_divided_by_class_and_then_by_length():
    walks = "walking_forward"
    assert _as_sets(make_clusters(INFOS, max_clips=4, min_clips=2)) == {
        # few enough clips: the whole top class
        "ground": {"ground_falling40", "ground_getting_up70"},
        "sport": {"sport44"},
        # 7 walks in two parts by length, the shorter ones first
        "walking-forward": {f"{walks}50", f"{walks}55", f"{walks}60", f"{walks}65"},
        "walking-forward-2": {f"{walks}280", f"{walks}300", f"{walks}310"},
        # two classes of one clip, put together
        "walking": {"walking_wander100", "walking_crouched90"},
    }


def test_every_clip_is_in_one_cluster_and_none_is_too_large():
    for most in (1, 2, 3, 5, 12):
        clusters = make_clusters(INFOS, most, min_clips=1)
        clips = [clip for cluster in clusters for clip in cluster.clips]
        assert sorted(clips) == sorted(info.name for info in INFOS)
        assert max(len(cluster.clips) for cluster in clusters) <= most


def test_the_order_of_the_clips_does_not_matter():
    mixed = random.Random(3).sample(INFOS, len(INFOS))
    assert make_clusters(mixed, 4, 2) == make_clusters(INFOS, 4, 2)


def test_clips_that_come_later_get_clusters_with_names_of_their_own():
    first = make_clusters(INFOS, 4, 2)
    later = make_clusters(_infos("walking/forward", 77), 4, 2, {c.name for c in first}, number=2)
    assert later == [Cluster("walking-2", ("walking_forward77",), 2)]
    assert make_clusters([], 4, 2) == []


def test_the_file_is_read_back_and_a_person_can_read_it(tmp_path):
    clusters = [*make_clusters(INFOS, 4, 2), single_cluster("a b/c", "specialists/ground", 2)]
    write_clusters(tmp_path, clusters)
    assert read_clusters(tmp_path) == clusters
    rows = yaml.safe_load((tmp_path / "clusters.yaml").read_text())["clusters"]
    assert rows[-1]["name"] == "single-a-b-c-2"
    assert rows[-1]["begins_from"] == "specialists/ground"
    assert read_clusters(tmp_path / "nowhere") == []


def test_a_damaged_file_is_said_so(tmp_path):
    (tmp_path / "clusters.yaml").write_text("clusters: [{name: x, clip: [a]}]")
    with pytest.raises(InputFileError, match=r"clusters.yaml: there is no setting clusters\[0\].clip"):
        read_clusters(tmp_path)


def test_a_folder_has_no_strange_signs_in_its_name():
    assert folder_name("../walking/x y") == "walking-x-y"
    assert folder_name("//") == "clip"
