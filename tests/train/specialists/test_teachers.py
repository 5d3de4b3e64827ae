import numpy as np
import pytest
import torch

from tests.train.specialists.samples import random_network, small_recipe
from unicon.errors import UniconError
from unicon.train.specialists.teachers import Teachers, read_teachers


def test_two_teachers_are_told_apart_by_the_clip_that_is_played():
    networks = [random_network(seed, small_recipe()) for seed in (0, 1)]
    teachers = Teachers(networks, np.array([0, 1, 0]), torch.float32)
    seen = torch.randn(5, 403, generator=torch.Generator().manual_seed(2))
    advice = teachers.advise(seen, np.array([0, 1, 2, 1, 1]))
    with torch.no_grad():
        for row, teacher in enumerate((0, 1, 0, 1, 1)):
            torch.testing.assert_close(advice.actions[row], networks[teacher].act(seen[row]))
            value = networks[teacher].value(networks[teacher].normalizer(seen[row]))
            torch.testing.assert_close(advice.values[row], value)
    apart = (networks[0].act(seen[0]) - networks[1].act(seen[0])).abs().max()
    assert apart > 0.01


def test_teachers_are_frozen():
    teachers = Teachers([random_network(0, small_recipe())], np.array([0]), torch.bfloat16)
    advice = teachers.advise(torch.ones(3, 403), np.zeros(3, np.int64))
    assert not advice.actions.requires_grad
    assert not any(p.requires_grad for p in teachers.networks[0].parameters())
    assert advice.actions.dtype == torch.float32


def test_a_clip_without_teacher_is_named():
    with pytest.raises(UniconError, match="1 clips have no teacher, 'walk' first"):
        read_teachers({}, ["walk"], 403, 35, torch.float32, torch.device("cpu"))
