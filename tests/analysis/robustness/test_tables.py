"""Tests of the tables of a measurement."""

from __future__ import annotations

import numpy as np
import pytest
from measuring import measure

from evoframe.analysis.robustness import find
from evoframe.analysis.robustness.tables import bodies_table, groups_table, pairs_table, ranking_table


class TestTables:
    def test_of_groups_have_the_scores_of_all_their_bodies(self) -> None:
        measured = measure([1.0, 2.0, 3.0], 40, groups="XXY", most=1.5)
        x, y = groups_table(find(measured)).to_dict(orient="records")
        assert (x["group"], x["bodies"], y["group"], y["bodies"]) == ("X", 2, "Y", 1)
        values = measured.values([0, 1])
        assert [x["least"], x["median"], x["greatest"]] == pytest.approx(
            [values.min(), np.median(values), values.max()]
        )
        assert x["positive"] == np.mean(values > 0)
        assert x["diverged"] + y["diverged"] == len(measured.diverged) > 0
        assert 0 <= x["Shapiro-Wilk p"] <= 1
        assert x["letters"]

    def test_of_bodies_have_a_line_per_body(self) -> None:
        measured = measure([1.0, 2.0, 1.0], 40)
        rows = bodies_table(measured).to_dict(orient="records")
        assert [row["body"] for row in rows] == ["A", "B", "C"]
        assert rows[0]["digest"] == rows[2]["digest"] != rows[1]["digest"]
        assert rows[1]["median"] == np.median(measured.scores[:, 1])

    def test_have_no_statistics_if_all_simulations_diverged(self) -> None:
        [row] = bodies_table(measure([1.0], 5, most=-9.0)).to_dict(orient="records")
        assert row["diverged"] == 5
        assert row["median"] is None

    def test_of_pairs_have_all_tests(self) -> None:
        found = find(measure([1.0, 2.0, 3.0] * 5, 40, groups="XXY" * 5))
        [row] = pairs_table(found).to_dict(orient="records")
        assert found.within is not None
        assert found.by_body is not None
        block = found.within.pair(row["first"], row["second"])
        assert (row["Wilcoxon p"], row["wins"]) == (block.p, block.wins)
        by_body = found.by_body.pair(row["first"], row["second"])
        assert (row["Dunn p by body"], row["A12 by body"]) == (by_body.p, by_body.a12)

    def test_of_small_groups_have_no_p_values(self) -> None:
        found = find(measure([1.0, 2.0, 3.0], 4, groups="XXY"))
        [row] = pairs_table(found).to_dict(orient="records")
        for name in ("Dunn p", "Wilcoxon p", "Dunn p by body"):
            assert row[name] is None
        assert row["wins"] is not None
        ranking = ranking_table(found)
        assert len(ranking) == 3
        assert ranking[["test", "statistic", "p"]].isna().all(axis=None)
        enough = find(measure([1.0, 2.0, 3.0], 5, groups="XXY"))
        [row] = pairs_table(enough).to_dict(orient="records")
        assert None not in (row["Dunn p"], row["Wilcoxon p"])
        assert row["Dunn p by body"] is None

    def test_of_rankings_have_a_line_per_comparison(self) -> None:
        three = ranking_table(find(measure([1.0, 2.0, 3.0] * 5, 40, groups="XYZ" * 5)))
        assert list(three["compared"]) == [
            "independent controllers", "within controllers", "medians of bodies",
        ]  # fmt: skip
        assert list(three["test"]) == ["Kruskal-Wallis", "Friedman", "Kruskal-Wallis"]
        assert list(three["effect size"]) == ["epsilon squared", "Kendall's W", "epsilon squared"]
        two = ranking_table(find(measure([1.0, 2.0], 40)))
        assert list(two["test"]) == ["Kruskal-Wallis", "Wilcoxon"]
        assert list(two["effect size"]) == ["epsilon squared", "wins"]
