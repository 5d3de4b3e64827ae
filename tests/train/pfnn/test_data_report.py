"""Tests for data_report.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.pfnn.walking_samples import walker
from unicon.train.pfnn.data_report import (
    REPORT_FILE,
    as_markdown,
    report_of,
    slides,
    title_of,
    write_report,
)
from unicon.train.pfnn.synthesis import bend, plant, sequence
from unicon.train.pfnn.training_data import TrainingData, samples_of


@pytest.fixture(scope="module")
def data():
    """A straight walk, and a bent one."""
    walk = sequence([walker("walk", 6.0, speed=0.7).frames], [])
    parts = [samples_of(plant(walk)), samples_of(plant(bend(walk, 0.5)))]
    counts = [len(part.phases) for part in parts]
    return TrainingData(
        *(np.concatenate(columns) for columns in zip(*parts, strict=True)),
        sequences=np.repeat([0, 1], counts),
        names=("a bent +0 x1", "a bent +29 x1"),
        held_out=np.zeros(sum(counts), dtype=bool),
        kinds=("walking", "walking"),
    )


def test_a_title_says_what_was_done_to_a_take():
    assert title_of("07_01 bent +0 x1 mirrored", "walking") == "walking"
    assert title_of("07_01 reversed bent -30 x0.5", "backward") == "backward, reversed, bent"
    assert title_of("07_07 on the spot +60", "turning") == "turning, on the spot"
    assert title_of("07_07 strides 0.5 bent +0", "walking") == "walking, short strides"


def test_rows_have_minutes_speeds_and_turns(data):
    straight, bent = report_of(data)
    assert (straight.title, bent.title) == ("walking", "walking, bent")
    assert straight.minutes == pytest.approx(0.1)
    assert straight.forward_m_s == pytest.approx((0.7, 0.7), abs=0.02)
    assert straight.turn_deg_s == pytest.approx((0.0, 0.0), abs=0.5)
    assert bent.turn_deg_s[1] == pytest.approx(np.degrees(0.5), rel=0.05)
    assert sum(bent.gaits) == pytest.approx(1.0)
    assert "| walking, bent | 1 | 0.1 |" in as_markdown([straight, bent])


def test_the_rows_are_written_into_the_folder_of_the_network(data, tmp_path):
    write_report(tmp_path / "pfnn", data)
    assert (tmp_path / "pfnn" / REPORT_FILE).read_text() == as_markdown(report_of(data))


def test_who_goes_faster_than_the_legs_slides_by_the_difference(data):
    outputs = data.outputs[data.sequences == 0].copy()
    outputs[:, 0] += 0.3  # of the root, forward
    faster, planted = slides(outputs), slides(data.outputs[data.sequences == 0])
    assert np.median(planted) < 0.05
    assert np.median(faster) == pytest.approx(0.3, abs=0.05)
