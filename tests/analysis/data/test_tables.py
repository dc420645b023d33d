"""Tests of the tables of a study."""

from __future__ import annotations

import math

import attrs
import pytest

from evoframe.analysis.data.studies import StudyData
from evoframe.analysis.data.tables import (
    comparisons,
    pairs_article,
    pairs_table,
    ranking_article,
    ranking_table,
    summary_article,
    summary_table,
    verification_table,
    versions_table,
)
from evoframe.contract import Score
from evoframe.record.verification import Finding, Verification
from evoframe.study.rows import Row

ROW = Row({}, 0, 1, "", "", 1.0, 1.0, 1.0, 1, 1, 1.0, "")


def data(*averages: str, runs: int = 6) -> StudyData:
    """Return a study in which each average is better than the one before it."""
    rows = [
        attrs.evolve(
            ROW,
            settings={"collaboration.n": n, "aggregator": average},
            run=run,
            score=place + run / 100,
            fitness=place + run / 50,
        )
        for n in ("2", "3")
        for place, average in enumerate(averages)
        for run in range(runs)
    ]
    return StudyData("s", ("collaboration.n", "aggregator"), "m", len(rows), tuple(rows))


def test_each_view_is_compared_on_both_yardsticks() -> None:
    found = comparisons(data("am", "wm"), "none")
    assert [(each.view.title, each.yardstick) for each in found] == [
        (title, yardstick)
        for yardstick in ("score", "fitness")
        for title in ("n = 2", "n = 3", "best of each")
    ]
    assert {each.comparison.correction for each in found if each.comparison} == {"none"}


def test_the_summary_has_a_line_for_each_group() -> None:
    table = summary_table(comparisons(data("am", "wm")), "m")
    [row] = table[
        (table["view"] == "n = 2") & (table["group"] == "WM") & (table["yardstick"] == "score")
    ].to_dict(orient="records")
    assert row["runs"] == 6
    assert row["median (mm)"] == pytest.approx(1025)
    assert row["mean (mm)"] == pytest.approx(1000 * math.fsum(1 + run / 100 for run in range(6)) / 6)
    assert row["letters"]


def test_tables_for_articles_have_the_lines_of_the_tables() -> None:
    found = comparisons(data("am", "wm", "gm"))
    summary, pairs, ranking = summary_article(found, "m"), pairs_article(found), ranking_article(found)
    assert list(summary["group"]) == list(summary_table(found)["group"])
    [line] = summary[
        (summary["heading"] == "n = 2, score of the best pair") & (summary["group"] == "WM")
    ].to_dict(orient="records")
    assert (line["median (mm)"], line["quartiles (mm)"]) == ("1025", "1012 to 1038")
    assert [float(a12) for a12 in pairs["A12"]] == pytest.approx(list(pairs_table(found)["A12"]), abs=0.005)
    assert list(ranking["ranking"]) == list(ranking_table(found)["ranking"])
    small = comparisons(data("am", "wm", runs=4))
    assert set(pairs_article(small)["Dunn p"]) == set(ranking_article(small)["p"]) == {"-"}
    assert set(ranking_article(small)["H"]) == {"-"}


def test_verifications_are_in_millimeters() -> None:
    half = Finding("half", (Score(0.001),))
    table = verification_table(Verification(Score(0.002), (half,), "m"))
    assert list(table["median (mm)"]) == [2.0, 1.0]
    assert list(table["of unchanged"]) == [1.0, 0.5]


def test_pairs_are_complete_and_sorted_from_the_best_down() -> None:
    found = comparisons(data("am", "wm", "gm"))
    pairs, rankings = pairs_table(found), ranking_table(found)
    within = pairs[(pairs["view"] == "n = 2") & (pairs["yardstick"] == "score")]
    assert [*zip(within["first"], within["second"], strict=True)] == [
        ("GM", "WM"),
        ("GM", "AM"),
        ("WM", "AM"),
    ]
    assert set(within["A12"]) == {1.0}
    [ranking, *_] = rankings["ranking"]
    assert ranking.startswith("GM ")


def test_a_single_group_is_described_but_not_compared() -> None:
    found = comparisons(data("am"))[:1]
    assert found[0].comparison is None
    assert list(summary_table(found)["letters"]) == [""]
    for table in (pairs_table(found), ranking_table(found)):
        assert table.empty
        assert {"view", "yardstick"} < set(table.columns)


def test_groups_of_fewer_than_five_runs_have_no_p_values() -> None:
    found = comparisons(data("am", "wm", runs=4))
    assert pairs_table(found)["Dunn p"].isna().all()
    assert set(pairs_table(found)["A12"]) <= {0.5, 1.0}
    assert ranking_table(found)[["Kruskal-Wallis H", "p"]].isna().all(axis=None)
    assert ranking_table(found)["ranking"][0] == "WM, AM"
    assert set(summary_table(found)["letters"]) == {""}
    assert comparisons(data("am", "wm", runs=5))[0].comparison is not None
    assert not pairs_table(comparisons(data("am", "wm", runs=5)))["Dunn p"].isna().any()


def test_groups_of_one_run_are_not_compared() -> None:
    found = comparisons(data("am", "wm", runs=1))
    assert {each.comparison for each in found} == {None}
    assert len(summary_table(found)) == sum(len(each.groups) for each in found) > 2
    assert pairs_table(found).empty
    assert ranking_table(found).empty


def test_versions_are_leaves_of_the_provenance() -> None:
    table = versions_table({"evoframe": "1", "cpu": {"features": ["a", "b"]}})
    assert dict(zip(table["what"], table["which"], strict=True)) == {"evoframe": "1", "cpu.features": "a, b"}
    assert versions_table({}).empty
