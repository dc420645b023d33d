"""Cells are called in one way wherever they are named."""

from __future__ import annotations

import pytest

from evoframe.study.names import name_of, title_of


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


def test_what_cells_share_is_listed() -> None:
    assert title_of({"collaboration.n": "2", "aggregator": "wm"}) == "n = 2, aggregator = wm"
