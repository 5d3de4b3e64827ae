from io import StringIO

import pytest
from rich.console import Console

from unicon.errors import UnknownNameError
from unicon.motion.catalogue.subsets import SUBSETS, subset, subset_sizes, subset_table, subsets_as_json
from unicon.motion.clip_index import ClipInfo

ROWS = [
    ClipInfo("a", 100, "walking/forward"),
    ClipInfo("b", 200, "walking"),
    ClipInfo("c", 300, "running/turn"),
    ClipInfo("d", 400, "dance/salsa"),
    ClipInfo("e", 500, "sport/golf"),
    ClipInfo("f", 600, "casual/idle"),
    ClipInfo("g", 700, "animal/bird"),
    ClipInfo("h", 800, "special_style/zombie"),
]


def test_the_sizes_of_a_small_library_by_hand():
    sizes = {size.name: (size.motions, size.frames, size.average) for size in subset_sizes(ROWS)}
    assert sizes == {
        "All": (8, 3600, 450.0),
        "RunJumpWalk": (3, 600, 200.0),
        "Casual": (1, 600, 600.0),
        "SportDance": (2, 900, 450.0),
        "Animal": (1, 700, 700.0),
        "Walk": (2, 300, 150.0),
    }


def test_an_empty_library_has_averages_of_zero():
    assert {size.average for size in subset_sizes([])} == {0.0}


def test_a_class_that_begins_alike_does_not_belong():
    assert not subset("Walk").holds(ClipInfo("x", 60, "walking_stick/forward"))


def test_names_are_known_in_any_letters():
    assert subset("runjumpwalk") is SUBSETS[1]
    with pytest.raises(UnknownNameError, match="'Swim'; there are All, RunJumpWalk"):
        subset("Swim")


def test_what_is_not_known_of_the_paper_is_null_in_files():
    table = {entry["name"]: entry for entry in subsets_as_json(subset_sizes(ROWS))}
    assert table["Walk"]["paper_motions"] is None
    assert table["All"]["paper_motions"] == 3352
    assert table["All"]["paper_average_frames"] == 280
    assert table["Walk"]["average_seconds"] == 2.5


def test_the_printed_table_shows_ours_beside_the_papers():
    console = Console(width=120, file=StringIO())
    console.print(subset_table(subset_sizes(ROWS)))
    text = console.file.getvalue()
    walk = next(line for line in text.splitlines() if "│ Walk" in line)
    assert "300" in walk
    assert "not stated" in walk
    assert "939,000" in text
