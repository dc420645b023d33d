"""Names of cells, the same wherever they are shown."""

from __future__ import annotations

import pytest
from hypothesis import given, strategies as st

from evoframe.study.names import headings, name_of, title_of


@pytest.mark.parametrize(
    ("settings", "name"),
    [
        ({}, ""),
        ({"aggregator": "wm"}, "WM"),
        ({"collaboration.n": "2", "aggregator": "wm"}, "WM (n = 2)"),
        ({"a.b": "2", "c": "x", "simulator.name": "vox"}, "vox (b = 2, c = x)"),
    ],
)
def test_the_last_setting_comes_first(settings: dict[str, str], name: str) -> None:
    assert name_of(settings) == name


def test_shared_settings_are_listed() -> None:
    names = {"collaboration.n": "n", "aggregator": "mean", "other": "unused"}
    assert title_of({"collaboration.n": "2", "aggregator": "wm"}, names) == "n = 2, mean = wm"


def test_keys_are_as_long_as_it_takes_to_distinguish_them() -> None:
    keys = ("a.evolver.rate", "b.evolver.rate", "simulator.name", "aggregator", "x.aggregator")
    assert headings(keys) == {
        "a.evolver.rate": "a.evolver.rate",
        "b.evolver.rate": "b.evolver.rate",
        "simulator.name": "name",
        "aggregator": "aggregator",
        "x.aggregator": "x.aggregator",
    }
    assert name_of({"p.a.size": "3", "p.b.size": "4"}) == "4 (a.size = 3)"


@given(st.sets(st.lists(st.sampled_from("abc"), min_size=1, max_size=4).map(".".join), max_size=6))
def test_no_two_keys_have_the_same_name(keys: set[str]) -> None:
    found = headings(keys)
    assert len(set(found.values())) == len(keys)
    assert all(f".{key}".endswith(f".{name}") for key, name in found.items())
