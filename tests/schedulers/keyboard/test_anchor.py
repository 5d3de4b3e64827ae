"""Tests for anchor.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon import rotations, state
from unicon.humanoid import HUMANOID
from unicon.schedulers.keyboard.anchor import Anchor, anchor_between

FINITE = st.floats(-9.0, 9.0)


def at(x: float, y: float, heading: float) -> state.CharacterState:
    return state.move(HUMANOID.rest_state(), np.array(heading), np.array([x, y, 0.0]))


def test_a_quarter_turn_and_a_shift_by_hand():
    anchor = Anchor(np.pi / 2, (1.0, 0.0))
    assert anchor.to_world(np.array([2.0, 0.0])) == pytest.approx([1.0, 2.0])
    assert anchor.to_source(np.array([1.0, 2.0])) == pytest.approx([2.0, 0.0])


def test_a_frame_that_was_left_where_it_is_has_no_anchor():
    frame = at(2.0, -1.0, 0.7)
    anchor = anchor_between(frame, frame)
    assert anchor.turn == 0.0
    assert anchor.offset_w == pytest.approx((0.0, 0.0))


@given(FINITE, FINITE, st.floats(-3.0, 3.0))
def test_there_and_back_is_the_same_place(x, y, turn):
    anchor = Anchor(turn, (y, -x))
    assert np.allclose(anchor.to_source(anchor.to_world(np.array([x, y]))), [x, y])


@given(FINITE, FINITE, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_the_anchor_between_two_frames_brings_one_to_the_other(x, y, sent_heading, heading):
    sent, anchored = at(x, 1.0, sent_heading), at(-2.0, y, heading)
    anchor = anchor_between(sent, anchored)
    assert np.allclose(anchor.to_world(sent.root_pos_w[:2]), anchored.root_pos_w[:2])
    turned = rotations.heading_angle(sent.root_quat_w) + anchor.turn
    assert np.cos(turned - heading) == pytest.approx(1.0)
