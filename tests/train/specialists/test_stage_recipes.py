from unicon.train.runs.recipe import read_recipe
from unicon.train.specialists.stage_recipes import generalist_recipe, specialist_recipe, student_recipe


def test_each_stage_has_its_own_noise_networks_and_budget():
    whole = read_recipe("specialists")
    stages = [
        make(whole, ("a", "b"), minutes)
        for make, minutes in ((generalist_recipe, 5.0), (specialist_recipe, 2.0), (student_recipe, 9.0))
    ]
    assert [stage.run.minutes for stage in stages] == [5.0, 2.0, 9.0]
    assert [stage.variance.points[0][1] for stage in stages] == [0.16, 0.11, 0.05]
    assert [stage.network.actor_sizes for stage in stages] == [(256, 256), (256, 256), (512, 512)]
    assert [stage.environment.threads for stage in stages] == [0, 1, 0]
    for stage in stages:
        assert stage.specialists is None
        assert stage.dataset.clips == ("a", "b")
        assert stage.ppo == whole.ppo
