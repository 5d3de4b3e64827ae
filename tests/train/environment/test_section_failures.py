"""Tests for section_failures.py."""

from __future__ import annotations

import numpy as np
import pytest

from unicon.train.environment.section_failures import SectionFailures

LENGTHS = np.array([65, 30, 150])  # 3, 1 and 5 sections


def test_every_clip_has_a_section_for_each_begun_half_second():
    failures = SectionFailures(LENGTHS, 4.0)
    assert failures.first.tolist() == [0, 3, 4]
    assert failures.clips.tolist() == [0, 0, 0, 1, 2, 2, 2, 2, 2]
    sections = failures.section(np.array([0, 0, 0, 2]), np.array([29, 30, 64, 149]))
    assert sections.tolist() == [0, 1, 2, 8]


def test_thirty_frames_in_a_section_are_a_visit():
    failures = SectionFailures(LENGTHS, 4.0)
    for _ in range(15):
        failures.add(np.array([1, 1, 2]), np.array([3, 9, 31]), np.array([False] * 3), frame_step=2)
    assert failures.visits[[3, 5]] == pytest.approx([2.0, 1.0])
    assert failures.visits.sum() == pytest.approx(3.0)


def test_the_share_of_failures_by_hand():
    failures = SectionFailures(LENGTHS, 4.0)
    failures.visits[:], failures.failures[4] = 9.0, 7.0
    assert failures.shares()[4] == pytest.approx(7.0 / 10)
    assert failures.shares()[0] == 0.0


def test_a_start_is_weighted_by_what_lies_before_it_in_its_own_clip():
    failures = SectionFailures(LENGTHS, cap=4.0)
    failures.visits[:] = 1e6
    failures.failures[7] = 0.5e6  # the fourth section of the last clip
    weights = failures.weights()
    expected = [1 + 3 * 0.343 * 0.5, 1 + 3 * 0.49 * 0.5, 1 + 3 * 0.7 * 0.5, 1 + 3 * 0.5, 1.0]
    assert weights[4:] == pytest.approx(expected, abs=1e-4)
    assert weights[:4] == pytest.approx(1.0, abs=1e-4)


def test_no_weight_is_above_the_cap():
    failures = SectionFailures(LENGTHS, cap=4.0)
    failures.failures[:], failures.visits[:] = 100.0, 1.0
    assert failures.weights() == pytest.approx(4.0)


def test_with_a_cap_of_one_failures_change_nothing():
    failures = SectionFailures(LENGTHS, cap=1.0)
    failures.failures[2] = 50.0
    assert np.array_equal(failures.weights(), np.ones(9))


def test_before_anyone_failed_all_starts_weigh_the_same():
    assert np.array_equal(SectionFailures(LENGTHS, cap=4.0).weights(), np.ones(9))


def test_only_about_the_last_twenty_visits_count():
    failures = SectionFailures(LENGTHS, 4.0)
    failures.visits[:2], failures.failures[:2] = [80.0, 10.0], [40.0, 5.0]
    failures.forget()
    assert failures.visits[:2] == pytest.approx([20.0, 10.0])
    assert failures.failures[:2] == pytest.approx([10.0, 5.0])
