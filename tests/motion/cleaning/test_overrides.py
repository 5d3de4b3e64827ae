"""Tests for overrides.py."""

from __future__ import annotations

import pytest

from unicon.errors import InputFileError
from unicon.motion.cleaning import Order, Overrides, load_overrides, shipped_overrides

WHOLE = """
- clips: "cmu*/60_*"
  reason: the partner is in the way
  cut: [[0, 12], [300, 310]]
  rate_hz: 60
  ignore: [idle_end]
- clips: "60_01"
  reason: it is a walk
  mark: [prop]
  unmark: [uneven_ground]
- clips: "*/bad.bvh"
  reason: broken
  drop: true
- clips: GOOD
  reason: fine
  keep: true
"""


def write(tmp_path, text: str):
    path = tmp_path / "overrides.yaml"
    path.write_text(text)
    return path


def test_a_file_is_read_and_its_entries_add_up(tmp_path):
    overrides = load_overrides(write(tmp_path, WHOLE))
    assert len(overrides.orders) == 4
    order = overrides.of("cmu_daz.zip/60_01.bvh")
    assert order.cut == ((0, 12), (300, 310)) and order.rate_hz == 60.0
    assert order.mark == ("prop",) and order.unmark == ("uneven_ground",)
    assert order.reason == "the partner is in the way; it is a walk"
    assert order.ignores("idle_end") and not order.ignores("root_jump")
    assert overrides.of("archive.zip/folder/bad.bvh").drop
    assert overrides.of("somewhere/good.bvh").ignores("root_jump")
    assert overrides.of("other/walk.bvh") == Order()


@pytest.mark.parametrize(
    ("pattern", "file", "fits"),
    [
        ("60_01", "a.zip/60_01.bvh", True),
        ("60_01", "a.zip/60_011.bvh", False),
        ("60_*", "60_01.bvh", True),
        ("a.zip/60_01", "/home/me/a.zip/60_01.bvh", True),
        ("a.zip/60_01", "/home/me/ba.zip/60_01.bvh", False),
        ("a*/x/60_01", "a.zip/x/60_01.bvh", True),
        ("60_01", "60_01\\x.bvh", False),
        ("x/60_01", "c:\\x\\60_01.bvh", True),
    ],
)
def test_patterns_are_of_the_name_or_of_the_path(pattern, file, fits):
    assert Order(pattern).fits(file) == fits


def test_what_all_orders_come_to_fits_every_file():
    order = Overrides((Order(clips="x[1]", reason="odd name", drop=True),)).of("x1")
    assert Overrides((order,)).of("anything [else].bvh").drop


def test_an_empty_file_says_nothing(tmp_path):
    assert load_overrides(write(tmp_path, "")) == Overrides()


def test_the_shipped_file_is_whole_and_gives_reasons():
    overrides = shipped_overrides()
    assert overrides.orders and all(order.reason for order in overrides.orders)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("clips: x", "holds a dict, expected a list of entries ('- clips: ...')"),
        ("- 5", "entry 1: is a int, expected 'clips', 'reason' and what to do"),
        (
            "- {clips: x, reason: y, dorp: true}",
            "entry 1 (x): has the field 'dorp'; known are clips, reason, drop,",
        ),
        ("- {clips: x, drop: true}", "entry 1 (x): lacks the text 'reason'"),
        ("- {reason: y, drop: true}", "entry 1: lacks the text 'clips'"),
        (
            "- {clips: 60_01, reason: y}",
            "entry 1 (6001): has a number for 'clips'; put the pattern in quotes",
        ),
        ("- {clips: x, reason: y}", "entry 1 (x): says nothing to do; expected one of drop, keep,"),
        ("- {clips: x, reason: y, drop: true, keep: true}", "says both drop and keep; leave one of them"),
        ("- {clips: x, reason: y, drop: maybe}", "has drop: 'maybe', expected true or false"),
        ("- {clips: x, reason: y, ignore: [ghosts]}", "has 'ghosts' in ignore; known are by_hand,"),
        ("- {clips: x, reason: y, ignore: idle_end}", "has ignore: 'idle_end', expected a list such as"),
        (
            "- {clips: x, reason: y, mark: [chair]}",
            "has 'chair' in mark; known are in_place, prop, uneven_ground",
        ),
        ("- {clips: x, reason: y, cut: 5}", "has cut: 5, expected a list such as [[0, 12]]"),
        ("- {clips: x, reason: y, cut: [[12, 0]]}", "has [12, 0] in cut, expected first and last frame"),
        ("- {clips: x, reason: y, cut: [[-1, 0]]}", "has [-1, 0] in cut"),
        ("- {clips: x, reason: y, cut: [3]}", "has 3 in cut"),
        ("- {clips: x, reason: y, rate_hz: fast}", "has rate_hz: 'fast', expected a number from 1 to 1000"),
        ("- {clips: x, reason: y, rate_hz: 0}", "has rate_hz: 0, expected a number from 1 to 1000"),
        ("- clips: [x", "line 1: is not YAML; expected a list of entries with 'clips' and 'reason'"),
    ],
)
def test_what_is_wrong_with_an_entry_is_said_in_one_sentence(tmp_path, text, sentence):
    path = write(tmp_path, text)
    with pytest.raises(InputFileError) as caught:
        load_overrides(path)
    message = str(caught.value)
    assert sentence in message and message.startswith(str(path)) and "\n" not in message


def test_a_second_entry_is_counted_and_named(tmp_path):
    path = write(tmp_path, "- {clips: x, reason: y, drop: true}\n- {clips: z, reason: y}\n")
    with pytest.raises(InputFileError, match=r"entry 2 \(z\): says nothing to do"):
        load_overrides(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputFileError, match="cannot be read"):
        load_overrides(tmp_path / "none.yaml")
