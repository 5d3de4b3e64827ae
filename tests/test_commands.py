"""Tests for commands.py."""

from __future__ import annotations

import pytest

from unicon.commands import LoadPolicy, Reset, SelectSource, ThrowProjectile, from_json, kind_of, to_json
from unicon.errors import UniconError
from unicon.projectile import Projectile

COMMANDS = [
    Reset("rest"),
    Reset("target"),
    SelectSource("stitching"),
    SelectSource(""),
    LoadPolicy("tracker"),
    ThrowProjectile(Projectile(mass_kg=0.1, azimuth_rad=1 / 3)),
]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_comes_back_from_json_as_it_was(command):
    assert from_json(kind_of(command), to_json(command)) == command


@pytest.mark.parametrize(
    ("kind", "arguments"),
    [("dance", "{}"), ("reset", "not json"), ("reset", '{"from": 1}'), ("throw_projectile", "{}")],
)
def test_what_is_no_command_is_refused(kind, arguments):
    with pytest.raises(UniconError):
        from_json(kind, arguments)
