"""Settings at the top of a report."""

from __future__ import annotations

from typing import Any

from evoframe.analysis.data.facts import facts_of


def tables(aggregator: str, seed: int = 1, **collaboration: Any) -> dict[str, Any]:
    return {
        "objective": {"name": "tip-dz", "every": 0.01},
        "aggregator": {"name": aggregator},
        "collaboration": collaboration,
        "run": {"seed": seed},
    }


def test_one_run() -> None:
    assert facts_of([tables("wm", 3, name="fittest", n=2)], "m") == {
        "objective": "tip-dz (mm)",
        "aggregator": "wm",
        "collaboration": "fittest",
        "n": "2",
        "seed": "3",
    }


def test_the_cells_of_a_study_list_each_value_once() -> None:
    cells = [
        tables("wm", name="fittest", n=3),
        tables("am", name="fittest", n=2),
        tables("wm", name="all"),
    ]
    assert facts_of(cells) == {
        "objective": "tip-dz",
        "aggregator": "wm, am",
        "collaboration": "fittest, all",
        "n": "3, 2",
        "seed": "1",
    }


def test_other_units_are_kept() -> None:
    assert facts_of([tables("wm", name="all")], "m/s")["objective"] == "tip-dz (m/s)"
