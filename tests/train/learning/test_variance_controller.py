import numpy as np
import pytest

from unicon.errors import UniconError
from unicon.train.learning.variance_controller import VarianceConfig, control_log_std, scheduled_log_std


def _std(config, progress, samples=0, size=2):
    return np.exp(scheduled_log_std(config, progress, samples, size))


def test_the_logarithm_is_linear_between_the_points():
    config = VarianceConfig(points=((0.0, 0.16), (0.5, 0.04), (1.0, 0.01)))
    assert _std(config, 0.0) == pytest.approx([0.16, 0.16])
    assert _std(config, 0.25) == pytest.approx([0.08, 0.08])  # the geometric mean
    assert _std(config, 0.75) == pytest.approx([0.02, 0.02])


def test_it_stays_beyond_the_last_point():
    config = VarianceConfig(points=((0.1, 0.2), (0.5, 0.1)))
    assert _std(config, 0.0) == pytest.approx([0.2, 0.2])
    assert _std(config, 1.0) == pytest.approx([0.1, 0.1])


def test_it_may_run_over_samples():
    config = VarianceConfig(points=((0.0, 0.4), (2.0, 0.1)), axis="million_samples")
    assert _std(config, 0.9, samples=1_000_000) == pytest.approx([0.2, 0.2])


def test_each_joint_has_its_factor():
    config = VarianceConfig(points=((0.0, 0.1),), joint_factors=(1.0, 0.5))
    assert _std(config, 0.3) == pytest.approx([0.1, 0.05])


def test_too_few_factors_are_refused():
    with pytest.raises(UniconError, match="got 2 numbers, expected 35"):
        _std(VarianceConfig(joint_factors=(1.0, 0.5)), 0.0, size=35)


@pytest.mark.parametrize("points", [(), ((0.0, 0.1), (0.0, 0.2)), ((0.0, 0.0),)])
def test_what_is_no_schedule_is_refused(points):
    with pytest.raises(UniconError, match="variance"):
        VarianceConfig(points=points)


LEARNED = np.array([-1.0, -3.0])


def test_controlled_deviations_keep_what_was_learned_and_have_the_schedules_mean():
    config = VarianceConfig(mode="controlled", points=((0.0, np.exp(-2.0)), (0.5, np.exp(-4.0))))
    assert control_log_std(config, LEARNED, 0.25, 0) == pytest.approx([-2.0, -4.0])  # mean -3


def test_after_the_last_point_the_controller_lets_go():
    config = VarianceConfig(mode="controlled", points=((0.0, 0.2), (0.5, 0.1)))
    assert control_log_std(config, LEARNED, 0.6, 0) == pytest.approx(LEARNED)


def test_the_other_modes_take_the_schedule_or_what_was_learned_alone():
    points = ((0.0, 0.2), (1.0, 0.1))
    scheduled = control_log_std(VarianceConfig(points=points), LEARNED, 0.0, 0)
    assert scheduled == pytest.approx(np.log([0.2, 0.2]))
    assert control_log_std(VarianceConfig(mode="learned", points=points), LEARNED, 0.0, 0) is LEARNED
