from io import StringIO

import pytest
from rich.console import Console

from unicon.errors import UnknownNameError
from unicon.motion.catalogue.class_tree import class_tree, rich_tree, top_class
from unicon.motion.clip_index import ClipInfo

ROWS = [
    ClipInfo("a", 61, "walking/forward"),
    ClipInfo("b", 121, "walking"),
    ClipInfo("c", 61, "dance/salsa/couple"),
    ClipInfo("d", 61, ""),
    ClipInfo("e", 61, "walking/forward"),
]


def test_children_are_in_the_order_of_their_names():
    assert [child.path for child in class_tree(ROWS).root.children] == ["dance", "other", "walking"]


def test_a_node_knows_its_own_clips_and_all_below():
    walking = class_tree(ROWS).node("walking")
    assert walking.own == (1,)
    assert walking.rows() == (0, 1, 4)
    assert walking.seconds == pytest.approx(4.0)


def test_the_tree_is_as_deep_as_its_labels():
    node = class_tree(ROWS).node("dance/salsa/couple")
    assert (node.name, node.own, node.children) == ("couple", (2,), ())


def test_a_clip_without_label_is_in_other():
    assert class_tree(ROWS).node("other").own == (3,)
    assert top_class("") == "other"


def test_slashes_too_many_make_no_nodes():
    assert class_tree([ClipInfo("a", 61, "/walking//forward/")]).node("walking/forward").own == (0,)


def test_a_tree_of_nothing_is_empty():
    assert class_tree([]).root.rows() == ()


def test_an_unknown_class_is_named_with_those_there_are():
    with pytest.raises(
        UnknownNameError, match="'swimming'; the classes at the top are dance, other, walking"
    ):
        class_tree(ROWS).node("swimming")


def test_the_drawn_tree_shows_clips_and_seconds_of_each_node():
    console = Console(width=80, file=StringIO())
    console.print(rich_tree(class_tree(ROWS)))
    lines = console.file.getvalue().splitlines()
    assert lines[0].split() == ["all", "5", "clips,", "6.0", "s"]
    assert any("forward  2 clips, 2.0 s" in line for line in lines)
    assert any("not further divided: 1 clip, 2.0 s" in line for line in lines)
