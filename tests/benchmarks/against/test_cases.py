"""Every case measures both commits; here both are this version, so that the results are equal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import attrs
import pytest

from benchmarks.against.cases import CASES
from benchmarks.against.comparison import SIDES, Command, Comparison
from benchmarks.child import CHILDREN, Child, started
from benchmarks.report import SectionError
from benchmarks.timing import QUICK

TINY = attrs.evolve(QUICK, rounds=1, run=("run.generations=1", *QUICK.run[1:]))


@pytest.fixture(scope="module")
def children() -> Iterator[dict[str, Child]]:
    command = [sys.executable, str(CHILDREN / "evoframe_child.py")]
    with started("this", command, {}) as this, started("other", command, {}) as other:
        yield dict(zip(SIDES, (this, other), strict=True))


@pytest.fixture
def comparison(children: dict[str, Child], tmp_path: Path) -> Comparison:
    return Comparison({"this": "a", "other": "b"}, children, tmp_path)


@pytest.mark.parametrize(
    "name", [name for name in CASES if name != "bending"]
)  # like locomotion, with longer simulations
def test_a_case_has_ratios_and_equal_results(comparison: Comparison, name: str) -> None:
    records = [row for table in CASES[name](comparison, TINY).tables for row in table.records()]
    assert {row["results"] for row in records} == {"equal bit for bit"}
    for row in records:
        lower, median, upper = (row[key] for key in ("lower quartile", "times as fast", "upper quartile"))
        assert isinstance(lower, float)
        assert isinstance(median, float)
        assert isinstance(upper, float)
        assert 0.0 < lower <= median <= upper


def test_an_error_of_one_commit_has_its_name(comparison: Comparison) -> None:
    with pytest.raises(SectionError, match=r"(?s)this cannot run: RuntimeError: .*no-such-preset"):
        comparison.run(Command("no-such-preset", []), TINY)
