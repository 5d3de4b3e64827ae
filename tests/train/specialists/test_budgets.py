import pytest

from unicon.train.specialists.budgets import choose_singles, cluster_minutes, round_budget, single_minutes
from unicon.train.specialists.clusters import Cluster
from unicon.train.specialists.config import SpecialistsConfig
from unicon.train.specialists.plan import ClipResult


def test_a_round_is_shared_out_by_the_shares():
    config = SpecialistsConfig(
        generalist_share=1, clusters_share=4, singles_share=2, distillation_share=2, finetuning_share=1
    )
    assert round_budget(100, config, first=True, has_clusters=True) == (10, 40, 20, 20, 10)
    # later there is no generalist, and perhaps no new clip
    assert round_budget(100, config, first=False, has_clusters=True) == (0, 50, 20, 20, 10)
    assert round_budget(100, config, first=False, has_clusters=False) == (0, 0, 70, 20, 10)


def test_a_cluster_gets_the_more_the_worse_its_clips_are_followed():
    results = {name: ClipResult(name, s, 0.0) for name, s in (("a", 1.0), ("b", 1.0), ("c", 0.2))}
    clusters = [Cluster("easy", ("a", "b")), Cluster("hard", ("c",))]
    # weights 0.2 + 0.2 and 0.2 + 0.8
    assert cluster_minutes(clusters, 14.0, results) == pytest.approx([4.0, 10.0])


def test_single_clips_are_those_that_fail_with_the_nearest_to_success_first():
    results = {
        "done": ClipResult("done", 1.0, 1.0),
        "strays": ClipResult("strays", 1.0, 0.8),
        "hard": ClipResult("hard", 0.3, 0.0),
        "near": ClipResult("near", 0.9, 0.9),
    }
    assert choose_singles(results, 10.0, 1.5) == ["strays", "near", "hard"]
    assert choose_singles(results, 3.0, 1.5) == ["strays", "near"]
    assert choose_singles(results, 1.0, 1.5) == []


def test_single_clips_share_the_minutes_up_to_twice_the_least():
    assert single_minutes(6.0, 3, 1.5) == 2.0
    assert single_minutes(60.0, 3, 1.5) == 3.0
    assert single_minutes(6.0, 0, 1.5) == 0.0
