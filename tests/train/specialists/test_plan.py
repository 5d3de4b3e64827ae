import pytest

from unicon.errors import InputFileError
from unicon.train.specialists.clusters import Cluster, single_cluster, write_clusters
from unicon.train.specialists.plan import ClipResult, Plan, StageResult, read_plan

WALKS, FLIPS = Cluster("walks", ("a", "b")), Cluster("flips", ("c",))


def _result(**clips: tuple[float, float]) -> StageResult:
    return StageResult(5.0, tuple(ClipResult(name, *figures) for name, figures in clips.items()))


def test_a_plan_is_read_back(tmp_path):
    plan = Plan(tmp_path)
    plan.begin_round(30.0, [WALKS, FLIPS])
    plan.finish("generalist", StageResult(12.5))
    plan.finish(WALKS.stage, _result(a=(1.0, 1.0), b=(0.5, 0.0)))
    assert read_plan(tmp_path) == plan
    assert read_plan(tmp_path / "nowhere") == Plan(tmp_path / "nowhere")


def test_the_teacher_of_a_clip_is_who_follows_it_best_and_the_latest_of_equals(tmp_path):
    plan = Plan(tmp_path)
    plan.begin_round(30.0, [WALKS, FLIPS])
    singles = [single_cluster(clip, WALKS.stage, 1) for clip in ("a", "b")]
    plan.add_clusters([*singles, single_cluster("c", FLIPS.stage, 2)])
    plan.finish(WALKS.stage, _result(a=(0.9, 0.5), b=(0.6, 0.0)))
    plan.finish(FLIPS.stage, _result(c=(0.4, 0.0)))
    plan.finish(singles[0].stage, _result(a=(0.9, 0.5)))
    plan.finish(singles[1].stage, _result(b=(0.5, 0.0)))
    plan.finish("specialists/single-c-2", _result(c=(1.0, 1.0)))
    first = {clip: cluster.name for clip, (cluster, _) in plan.teachers(1).items()}
    assert first == {"a": "single-a", "b": "walks", "c": "flips"}
    assert plan.teachers(2)["c"][0].name == "single-c-2"


def test_clusters_of_a_round_that_was_not_begun_in_full_are_made_again(tmp_path):
    Plan(tmp_path).begin_round(30.0, [WALKS])
    write_clusters(tmp_path, [WALKS, Cluster("late", ("d",), 2)])
    assert read_plan(tmp_path).clusters == [WALKS]


def test_clusters_that_are_there_stay_as_they_are(tmp_path):
    plan = Plan(tmp_path, clusters=[WALKS])
    plan.add_clusters([Cluster("walks", ("z",)), FLIPS])
    assert plan.clusters == [WALKS, FLIPS]


def test_a_damaged_plan_is_said_so(tmp_path):
    (tmp_path / "plan.json").write_text("{")
    with pytest.raises(InputFileError, match="plan.json: cannot be read as a plan"):
        read_plan(tmp_path)


def test_mastered_is_nothing_less_than_all():
    assert ClipResult("a", 1.0, 1.0).mastered
    assert not ClipResult("a", 1.0, 0.9).mastered
    assert not ClipResult("a", 0.99, 1.0).mastered
