"""Tests for network_facts.py and trained_limits.py."""

import numpy as np
import pytest

from tests.train.pfnn.toy_gait import make_toy_data
from unicon.motion.clip_index import ClipInfo
from unicon.schedulers.pfnn.layout import AHEAD, OUTPUT_LAYOUT, pack_output
from unicon.train.pfnn.network_facts import card_of_data
from unicon.train.pfnn.trained_limits import limits_of

INFOS = (
    ClipInfo("walk", 300, source="A", licence="free"),
    ClipInfo("walk_1", 300, source="B", licence="MIT"),
    ClipInfo("walk_10", 300, source="C", licence="MIT"),
)


def test_sources_stand_with_their_licences_takes_and_minutes():
    card = card_of_data("toy", make_toy_data(), INFOS, seed=4)
    assert card.training_data == (
        "A (licence: free): 2 takes and variants, 0.2 min",
        "B (licence: MIT): 1 takes and variants, 0.1 min",
    )
    assert card.takes == ("walk_0", "walk_1", "walk_3")
    assert card.held_out_takes == ("walk_2",)
    assert card.seed == 4


def test_gaits_have_their_speeds():
    card = card_of_data("toy", make_toy_data(), INFOS, 0)
    assert list(card.gait_speeds_m_s) == ["walk"]
    assert card.gait_speeds_m_s["walk"] == pytest.approx((0.8, 1.0667, 1.6), abs=1e-3)
    assert card.limits["forward_m_s"] == pytest.approx(1.6, abs=1e-3)


def _outputs(count, velocity, turn_rate):
    """Paths along which one goes and turns steadily."""
    seconds = np.arange(AHEAD) / 6.0
    parts = {name: np.zeros((count, *shape)) for name, shape in OUTPUT_LAYOUT}
    parts["path_pos_h"][:] = seconds[:, None] * np.array(velocity)
    angles = turn_rate * seconds
    parts["path_facing_h"][:] = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return pack_output(parts)


def test_each_direction_has_a_limit_of_its_own():
    samples = [
        _outputs(1000, (2.0, 0.0), 0.0),
        _outputs(400, (-0.7, 0.0), 0.0),
        _outputs(400, (0.0, -0.5), 0.0),
        _outputs(400, (0.0, 0.0), 4.5),  # more than half a turn ahead
    ]
    limits = limits_of(np.concatenate(samples))
    assert limits == pytest.approx(
        {"forward_m_s": 2.0, "backward_m_s": 0.7, "sideways_m_s": 0.5, "turn_rad_s": 4.5}
    )


def test_a_direction_that_is_hardly_there_has_not_been_trained():
    limits = limits_of(np.concatenate([_outputs(1000, (1.0, 0.0), 0.0), _outputs(200, (-1.0, 0.0), 0.0)]))
    assert limits["backward_m_s"] == 0.0
