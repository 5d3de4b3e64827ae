from dataclasses import dataclass, field
from typing import Literal

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from unicon.errors import InputFileError, UniconError
from unicon.train.runs.settings import build, plain


@dataclass(frozen=True)
class Inner:
    rate: float = 0.5
    sizes: tuple[int, ...] = (1,)
    kind: Literal["a", "b"] = "a"
    five: tuple[float, float] | None = None

    def __post_init__(self):
        if self.rate < 0:
            raise UniconError("inner.rate must not be negative")


@dataclass(frozen=True)
class Outer:
    count: int = 3
    active: bool = True
    points: tuple[tuple[float, float], ...] = ()
    inner: Inner = field(default_factory=Inner)


def test_what_is_not_named_keeps_its_default():
    assert build(Outer, {"inner": {"sizes": [4, 5]}}, "x.yaml") == Outer(inner=Inner(sizes=(4, 5)))


@given(st.integers(), st.booleans(), st.lists(st.tuples(st.floats(0, 9), st.floats(0, 9))), st.floats(0, 1))
def test_plain_values_are_built_back(count, active, points, rate):
    settings = Outer(count, active, tuple(points), Inner(rate, five=(1.0, 2.0)))
    assert build(Outer, yaml.safe_load(yaml.safe_dump(plain(settings))), "x.yaml") == settings


def test_what_yaml_takes_for_a_text_is_a_number_where_one_is_expected():
    assert build(Outer, yaml.safe_load("inner: {rate: 3e-4}"), "x.yaml").inner.rate == 3e-4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("inner: {ratee: 1}", "x.yaml: there is no setting inner.ratee; did you mean rate?"),
        ("zzz: 1", "x.yaml: there is no setting zzz; known are count, active, points, inner"),
        ("count: two", "x.yaml: count is 'two', expected a whole number"),
        ("count: true", "x.yaml: count is True, expected a whole number"),
        ("count: 2.5", "x.yaml: count is 2.5, expected a whole number"),
        ("active: 1", "x.yaml: active is 1, expected true or false"),
        ("inner: {rate: [1]}", "x.yaml: inner.rate is [1], expected a number"),
        ("inner: {kind: c}", "x.yaml: inner.kind is 'c', expected one of a, b"),
        ("inner: {sizes: 4}", "x.yaml: inner.sizes is 4, expected a list"),
        ("inner: {sizes: [4, x]}", "x.yaml: inner.sizes[1] is 'x', expected a whole number"),
        ("points: [[1, 2, 3]]", "x.yaml: points[0] has 3 entries, expected 2"),
        ("inner: {five: [1]}", "x.yaml: inner.five has 1 entries, expected 2"),
        ("inner: 5", "x.yaml: inner is 5, expected names with values"),
        ("[1]", "x.yaml: the file is [1], expected names with values"),
        ("inner: {rate: -1}", "x.yaml: inner.rate must not be negative"),
    ],
)
def test_a_mistake_is_one_sentence_with_file_and_field(text, message):
    with pytest.raises(InputFileError) as caught:
        build(Outer, yaml.safe_load(text), "x.yaml")
    assert str(caught.value) == message
