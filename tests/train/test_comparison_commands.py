"""Tests for comparison_commands.py."""

from __future__ import annotations

import pytest
import tyro
from rich.console import Console

from tests.train.small_library import make_library
from unicon.errors import UniconError
from unicon.train.comparison_commands import Compare
from unicon.train.scoring import comparison
from unicon.train.scoring.comparison_report import Outcome


def typed(tmp_path, *words) -> Compare:
    make_library(tmp_path / "library")
    return tyro.cli(
        Compare, args=["--out", str(tmp_path / "out"), "--library", str(tmp_path / "library"), *words]
    )


def test_what_is_typed_arrives(tmp_path, monkeypatch):
    asked = []

    def compare(library, out, recipes, config, console, changes):
        asked.append((library.folder, out, recipes, config, changes))
        return [Outcome(name, 1.0, 1.0, None, None, ()) for name in recipes]

    monkeypatch.setattr(comparison, "compare", compare)
    words = ["--recipes", "paper", "laptop+no-rsis", "--minutes", "2", "--dataset", "All", "--jobs", "1"]
    command = typed(tmp_path, *words, "--set", "ppo.epochs=1")
    console = Console(record=True, width=200)
    assert command.run(console) == 0
    config = comparison.ComparisonConfig(2.0, "All", 1, 6)
    assert asked == [
        (tmp_path / "library", tmp_path / "out", ("paper", "laptop+no-rsis"), config, ("ppo.epochs=1",))
    ]
    assert "laptop+no-rsis" in console.export_text()


def test_stopped_it_says_how_to_go_on(tmp_path, monkeypatch):
    monkeypatch.setattr(comparison, "compare", lambda *_: [])
    monkeypatch.setattr("sys.argv", ["unicon", "compare", "--out", "here"])
    console = Console(record=True, width=200)
    assert typed(tmp_path).run(console) == 130
    assert "stopped; go on with: unicon compare --out here" in console.export_text()


def test_no_budget_is_refused(tmp_path):
    with pytest.raises(UniconError, match="--minutes has to be above 0"):
        typed(tmp_path, "--minutes", "0").run(Console(quiet=True))
