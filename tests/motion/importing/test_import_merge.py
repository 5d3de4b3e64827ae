"""Tests for import_merge.py; test_import_run.py shows the whole."""

from __future__ import annotations

from unicon.motion.importing.import_merge import free_name


def test_a_taken_name_gets_its_folder_before_it_and_then_numbers():
    taken: set[str] = set()
    names = []
    for origin in ("b.zip/walk.bvh", "a.zip/inner/walk.bvh", "c/inner/walk.bvh", "d/inner/walk.bvh"):
        names.append(free_name("walk", origin, taken))
        taken.add(names[-1])
    assert names == ["walk", "inner_walk", "inner_walk_2", "inner_walk_3"]


def test_a_file_without_folder_gets_a_number():
    assert free_name("walk", "walk.bvh", {"walk"}) == "walk_2"
    assert free_name("walk", "/walk.bvh", {"walk"}) == "walk_2"


def test_a_name_never_looks_like_a_path():
    assert free_name("walk/fast", "x.bvh", set()) == "walk_fast"
