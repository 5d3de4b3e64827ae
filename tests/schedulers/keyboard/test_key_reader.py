"""Tests for key_reader.py."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from unicon.schedulers.keyboard.key_reader import PATIENCE_S, KeyReader
from unicon.schedulers.keyboard.key_table import Action, action_of

SENT = {
    "w": "w",
    "\x1b[A": "up",
    "\x1bOB": "down",
    "\x1b[1;2C": "right",  # Shift
    "\x1b[1;5D": "left",  # Ctrl
    "\x1b[3~": "escape",  # Delete
    "\x1b[15~": "escape",  # F5
    "\x1b[[A": "escape",  # F1 of the Linux console
    "\x1bOP": "escape",  # F1
    "\x1b[Z": "escape",  # Shift-Tab
}


@pytest.mark.parametrize(("sent", "key"), SENT.items())
def test_each_sequence_is_one_key(sent, key):
    assert KeyReader().read(sent, 0.0) == [key]


@given(st.lists(st.sampled_from(sorted(SENT)), max_size=6), st.integers(1, 4))
def test_keys_are_the_same_in_whatever_pieces_they_come(sent, size):
    reader, text = KeyReader(), "".join(sent)
    pieces = [text[i : i + size] for i in range(0, len(text), size)]
    keys = [key for piece in pieces for key in reader.read(piece, 0.0)]
    assert keys == [SENT[one] for one in sent]


def test_escape_alone_is_a_key_once_nothing_follows():
    reader = KeyReader()
    assert reader.read("\x1b", 1.0) == []
    assert reader.read("", 1.0 + 0.5 * PATIENCE_S) == []
    assert reader.read("", 1.0 + 1.5 * PATIENCE_S) == ["escape"]
    assert reader.read("", 9.0) == []


def test_a_sequence_that_is_not_finished_stops_and_nothing_else():
    reader = KeyReader()
    reader.read("\x1b[1;2", 1.0)
    assert [action_of(key) for key in reader.read("", 2.0)] == [Action.STOP]
