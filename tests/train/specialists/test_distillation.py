from dataclasses import replace

import numpy as np
import pytest
import torch

from tests.train.small_library import make_dataset
from tests.train.specialists.samples import random_network, small_recipe
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.ppo import NotFiniteError
from unicon.train.specialists.distillation import Distiller
from unicon.train.specialists.teachers import Teachers


def _distiller(folder, *changes: str) -> Distiller:
    """Two teachers: one of the two walks, one of the dance."""
    recipe = small_recipe(*changes)
    environment = TrackingEnvironment(make_dataset(folder), recipe.environment)
    networks = [random_network(seed, recipe, gain=0.2) for seed in (0, 1)]
    for network in networks:
        network.normalizer.commit(network.normalizer.moments._replace(count=torch.tensor(1.0)))
    teachers = Teachers(networks, np.array([0, 0, 1]), torch.float32)
    assert recipe.specialists
    student = replace(recipe, network=recipe.specialists.student)
    return Distiller(environment, student, teachers, recipe.specialists.distillation)


def _error_on_new_states(distiller: Distiller) -> tuple[float, float]:
    """Mean squared difference from each avatar's own teacher, and from the other one."""
    seen = torch.from_numpy(distiller.environment.reset())
    clips = distiller.environment.clips
    with torch.no_grad():
        actions = distiller.network.act(seen)
    own = distiller.teachers.advise(seen, clips).actions
    other = distiller.teachers.advise(seen, np.where(clips == 2, 0, 2)).actions
    return float((actions - own).square().mean()), float((actions - other).square().mean())


def test_the_student_learns_what_each_teacher_does_with_its_clips(tmp_path):
    distiller = _distiller(tmp_path)
    reports = [distiller.iterate(k / 50) for k in range(50)]
    first, last = reports[0].update, reports[-1].update
    assert last.surrogate < 0.2 * first.surrogate
    assert last.kl == pytest.approx(0.5 * 35 * last.surrogate / 0.05**2)
    assert last.value_loss < 0.3 * first.value_loss
    own, other = _error_on_new_states(distiller)
    assert own < 0.15 * other


def test_teachers_act_less_and_less_and_the_rate_falls_by_a_cosine(tmp_path):
    distiller = _distiller(tmp_path)
    shares = [distiller.teacher_share(progress) for progress in (0.0, 0.1, 0.4, 1.0)]
    assert shares == pytest.approx([1.0, 0.75, 0.0, 0.0])
    rates = [distiller.learning_rate(progress) for progress in (0.0, 0.5, 1.0)]
    assert rates == pytest.approx([1e-3, (1e-3 + 3e-5) / 2, 3e-5])


def test_who_acts_is_drawn_for_an_episode(tmp_path):
    distiller = _distiller(tmp_path)
    distiller.start()
    assert distiller._taught.all()
    begun = np.arange(32) < 16
    distiller._draw_actors(begun, 0.0)
    assert distiller._taught[:, 0].tolist() == (~begun).tolist()
    assert _distiller(tmp_path / "b", "specialists.distillation.teacher_until=0").teacher_share(0.0) == 0.0


def test_the_replay_keeps_every_state_that_was_seen(tmp_path):
    distiller = _distiller(tmp_path)
    report = distiller.iterate(0.0)
    assert distiller.replay.count == report.samples == 8 * 32
    assert report.update.clipped == 1.0


def test_what_is_not_finite_is_refused(tmp_path):
    distiller = _distiller(tmp_path)
    distiller.start()
    assert distiller.observation is not None
    distiller.observation[3, 5] = np.nan
    with pytest.raises(NotFiniteError, match="an observation"):
        distiller.iterate(0.0)
