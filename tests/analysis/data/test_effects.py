"""Effects of the keys of a two-way grid."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from evoframe.analysis.data.effects import effects_article, effects_table, factorials
from evoframe.analysis.data.studies import StudyData
from evoframe.study import Row

KEYS = ("aggregator", "collaboration.n")


def row(settings: dict[str, str], run: int, score: float) -> Row:
    return Row(settings, run, 0, "", "", score / 2, score, score, 8, 8, 0.1, "")


def study(keys: Sequence[str] = KEYS, runs: int = 5, without: tuple[str, ...] = ()) -> StudyData:
    """Return a study in which the aggregator has an effect."""
    rows = [
        row(dict(zip(keys, cell, strict=False)), run, 3.0 * (cell[0] == "am") + (run * 7 % 5) / 10)
        for cell in (("am", "2"), ("am", "3"), ("hm", "2"), ("hm", "3"))
        for run in range(runs)
        if cell != without
    ]
    return StudyData("s", tuple(keys), "m", len(rows), tuple(rows))


def test_each_measure_has_two_main_effects_and_an_interaction() -> None:
    found = factorials(study())
    assert [each.yardstick for each in found] == ["score", "fitness"]
    table = effects_table(found)
    assert table["effect"].tolist() == ["aggregator", "n", "aggregator x n"] * 2
    assert (table.loc[table["effect"] == "aggregator", "p"] < 0.001).all()
    assert (table.loc[table["effect"] != "aggregator", "p"] > 0.05).all()
    assert (table["df residual"] == 16).all()


def test_the_table_of_an_article_has_the_same_lines() -> None:
    found = factorials(study())
    article = effects_article(found)
    assert article["effect"].tolist() == effects_table(found)["effect"].tolist()
    assert article["p"][0] == "< 0.001"


@pytest.mark.parametrize(
    "data",
    [
        study(runs=4),
        study(without=("hm", "3")),
        study(keys=("aggregator",)),
        StudyData("s", KEYS, "m", 0, ()),
    ],
)
def test_other_studies_have_no_effects(data: StudyData) -> None:
    assert factorials(data) == []
