"""The comparison with the published rankings."""

from __future__ import annotations

from pathlib import Path

import attrs
import pytest

from benchmarks.published import OVERALL, WITHIN, cells, groups_of, lines, rankings, verdict
from evoframe.study.rows import Row, read_rows

ROWS = Path(__file__).parents[2] / "docs" / "results" / "paper" / "rows.csv"


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    return read_rows(ROWS)


@pytest.mark.parametrize(
    ("relation", "p", "direction", "expected"),
    [
        (">", 0.01, 1, "agrees"),
        (">", 0.01, -1, "**disagrees**"),
        (">", 0.2, 1, "cannot tell"),
        ("=", 0.2, 1, "agrees"),
        ("=", 0.01, -1, "**disagrees**"),
    ],
)
def test_a_verdict_agrees_or_disagrees_or_is_undecided(
    relation: str, p: float, direction: int, expected: str
) -> None:
    assert verdict(relation, p, direction) == expected


def test_every_published_relation_has_a_line(rows: list[Row]) -> None:
    listed = [line.split(" | ")[1] for line in [*rankings(rows)][2:]]
    assert listed == [text for published in WITHIN.values() for text in published] + list(OVERALL)


def test_every_cell_has_a_line(rows: list[Row]) -> None:
    listed = [line.split(" | ")[:2] for line in [*cells(rows)][2:]]
    assert len(listed) == 20
    assert ["| 10", "HM"] in listed


def test_a_clear_difference_agrees_in_its_direction(rows: list[Row]) -> None:
    every = groups_of(rows)
    better = [attrs.evolve(row, score=row.score + 1.0, fitness=row.fitness + 1.0) for row in every["WM(2)"]]
    groups = {"WM": better, "AM": every["AM(2)"], "GM": every["GM(2)"]}
    first, second = lines(groups, ("WM > AM", "GM > WM"), "2")
    assert first.count("agrees") == 4
    assert first.count("A12 1.00") == 4
    assert second.count("**disagrees**") == 4
