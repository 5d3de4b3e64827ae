"""Tests for target_sources.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.samples import START_NS, TICK_NS, message, standing
from unicon import rotations
from unicon.state import CharacterState, move
from unicon.target_frames import RejectedTargetsError, RejectReason, TargetLimits, check
from unicon.target_sources import TargetSources, anchor_at


def offer(sources: TargetSources, name: str, sequence: int, tick: int, state: CharacterState) -> None:
    raw = message(sequence, START_NS + tick * TICK_NS, state, state, source=name, interval_s=1.0)
    sources.offer(check(raw, None, TargetLimits()), START_NS + tick * TICK_NS)


def sample(sources: TargetSources, tick: int, avatar: CharacterState) -> CharacterState | None:
    now = START_NS + tick * TICK_NS
    frames = sources.sample(np.array([now + TICK_NS]), now, avatar)
    if frames is not None:
        sources.remember(frames[0])
        return frames[0]
    return None


def test_without_a_source_there_is_no_target():
    assert sample(TargetSources(), 0, standing()) is None


def test_a_source_is_anchored_to_the_avatars_place_and_heading():
    sources, avatar = TargetSources(), move(standing(), 1.0, np.array([5.0, 6.0, 0.0]))
    offer(sources, "a", 0, 0, move(standing(), -2.0, np.array([-30.0, 4.0, 0.0])))
    target = sample(sources, 0, avatar)
    assert np.allclose(target.root_pos_w, avatar.root_pos_w)
    assert np.isclose(rotations.heading_angle(target.root_quat_w), 1.0)


def test_an_anchor_leaves_the_height_alone():
    source = move(standing(), 0.3, np.array([1.0, 2.0, 0.4]))
    anchored = anchor_at(source, standing()).apply(source)
    assert np.isclose(anchored.root_pos_w[2], standing().root_pos_w[2] + 0.4)


def test_the_one_that_began_last_is_followed_and_blends_in():
    sources = TargetSources()
    for tick in range(60):
        offer(sources, "a", tick, tick, standing())
        if tick >= 30:
            crouched = CharacterState(**{**vars(standing()), "joint_pos": np.full(35, 0.4)})
            offer(sources, "b", tick, tick, crouched)
        target = sample(sources, tick, standing())
        assert sources.source == ("a" if tick < 30 else "b")
        if tick == 37:
            assert 0.05 < target.joint_pos[0] < 0.35
    assert np.allclose(target.joint_pos, 0.4)


def test_a_selected_source_is_followed_whoever_begins():
    sources = TargetSources()
    sources.selected = "a"
    offer(sources, "a", 0, 0, standing())
    offer(sources, "b", 0, 0, standing())
    sample(sources, 0, standing())
    assert sources.source == "a"
    assert sources.live(START_NS) == ["a", "b"]


def test_when_the_followed_one_falls_silent_a_live_one_takes_over():
    sources = TargetSources()
    for tick in range(90):
        offer(sources, "steady", tick, tick, standing())
        if 10 <= tick < 30:
            offer(sources, "brief", tick, tick, standing())
        sample(sources, tick, standing())
    assert sources.source == "steady"


def test_an_older_sequence_is_refused_while_the_source_is_live():
    sources = TargetSources()
    offer(sources, "a", 5, 0, standing())
    for sequence in (5, 4, 0):
        with pytest.raises(RejectedTargetsError) as caught:
            offer(sources, "a", sequence, 10, standing())
        assert caught.value.reason is RejectReason.OLD_SEQUENCE
    offer(sources, "a", 6, 10, standing())


def test_a_restarted_source_may_count_from_zero_and_is_anchored_anew():
    sources, away = TargetSources(), standing(3.0)
    offer(sources, "a", 100, 0, standing())
    sample(sources, 0, standing())
    offer(sources, "a", 0, 40, standing())
    target = sample(sources, 40, away)
    later = [sample(sources, tick, away) for tick in range(41, 60)][-1]
    assert target is not None
    assert np.allclose(later.root_pos_w[:2], away.root_pos_w[:2])


def test_many_names_do_not_fill_the_memory():
    sources = TargetSources()
    for k in range(500):
        offer(sources, f"s{k}", 0, k, standing())
        sample(sources, k, standing())
    assert len(sources.live(START_NS + 499 * TICK_NS)) <= sources.config.max_sources
