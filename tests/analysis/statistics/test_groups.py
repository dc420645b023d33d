"""Tests of statistics of independent groups, against R's output and by invariants."""

from __future__ import annotations

import itertools
import random
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from evoframe.analysis.statistics.corrections import CORRECTIONS
from evoframe.analysis.statistics.groups import FEWEST, a12, compare, detectable_a12

# R's dataset airquality: mean ozone in parts per billion, New York, May to September 1973, without missing
# values. Source: Chambers et al. 1983, Graphical Methods for Data Analysis.
_OZONE = """
May: 41 36 12 18 28 23 19 8 7 16 11 14 18 14 34 6 30 11 1 11 4 32 23 45 115 37
June: 29 71 39 23 21 37 20 12 13
July: 135 49 32 64 40 77 97 97 85 10 27 7 48 35 61 79 63 16 80 108 20 52 82 50 64 59
August: 39 9 16 78 35 66 122 89 110 44 28 65 22 59 23 31 44 21 9 45 168 73 76 118 84 85
September: 96 78 73 91 47 32 20 23 21 24 44 21 28 9 13 46 18 13 24 16 13 23 36 7 14 30 14 18 20
"""
OZONE = {
    month: [float(value) for value in values.split()]
    for month, values in (line.split(":") for line in _OZONE.strip().splitlines())
}


class TestAgainstR:
    def test_kruskal_wallis(self) -> None:
        # kruskal.test(Ozone ~ Month, data = airquality), the example of its manual page:
        # chi-squared is 29.267 with 4 degrees of freedom, the p-value 6.901e-06.
        comparison = compare(OZONE)
        assert comparison.h == pytest.approx(29.267, abs=5e-4)
        assert comparison.p == pytest.approx(6.901e-06, abs=5e-10)

    def test_dunn(self) -> None:
        # dunn.test(airquality$Ozone, airquality$Month), the example of its manual page, z and one-sided p
        # without correction; twice that is the two-sided one.
        comparison = compare(OZONE, "none")
        for first, second, z in [
            ("May", "June", -0.925158),
            ("May", "July", -4.419470),
            ("June", "July", -2.244208),
            ("May", "August", -4.132813),
            ("June", "August", -2.038635),
            ("July", "August", 0.286657),
            ("May", "September", -1.321202),
            ("June", "September", 0.002538),
            ("July", "September", 3.217199),
            ("August", "September", 2.922827),
        ]:
            p = 2 * (1 - NormalDist().cdf(abs(z)))
            assert comparison.pair(first, second).p == pytest.approx(p, abs=2e-6)

    def test_holm(self) -> None:
        # p.adjust(c(0.01, 0.02, 0.03), "holm") is 0.03, 0.04, 0.04: times 3, 2, 1, and never falling.
        raw = sorted(pair.p for pair in compare(OZONE, "none").pairs)
        holm = sorted(pair.p for pair in compare(OZONE, "holm").pairs)
        expected = np.minimum(1, np.maximum.accumulate([p * (10 - i) for i, p in enumerate(raw)]))
        assert holm == pytest.approx(expected.tolist())

    def test_kruskal_wallis_of_small_groups(self) -> None:
        # kruskal.test(list(x, y, z)) of its manual page, after Hollander and Wolfe 1973, 116:
        # chi-squared is 0.77143 with 2 degrees of freedom, the p-value 0.68.
        x, y, z = [2.9, 3.0, 2.5, 2.6, 3.2], [3.8, 2.7, 4.0, 2.4], [2.8, 3.4, 3.7, 2.2, 2.0]
        comparison = compare({"x": x, "y": y, "z": z})
        assert comparison.h == pytest.approx(0.77143, abs=5e-6)
        assert comparison.p == pytest.approx(0.68, abs=5e-3)
        assert comparison.epsilon_squared == pytest.approx(0.77143 / 13, abs=5e-6)


def test_the_ranking_of_the_months() -> None:
    comparison = compare(OZONE)
    assert comparison.ranking == "July = August = June = September = May"  # signs compare neighbors only
    assert comparison.letters["August"] == comparison.letters["July"]
    assert not set(comparison.letters["May"]) & set(comparison.letters["July"])


def test_outliers_do_not_reverse_a_ranking() -> None:
    usual, better = np.linspace(5.0, 5.2, 28).tolist(), np.linspace(5.3, 5.5, 30).tolist()
    comparison = compare({"A": [*usual, 60.0, 60.0], "B": better})
    assert comparison.ranking == "B > A"
    assert comparison.pair("B", "A").a12 > 0.9
    assert comparison.pair("A", "B").direction == -1


@pytest.mark.parametrize(("runs", "tested"), [(4, False), (5, True)])
def test_groups_of_fewer_than_five_values_are_not_tested(runs: int, tested: bool) -> None:
    comparison = compare({"A": [float(n) for n in range(30)], "B": [50.0 + n for n in range(runs)]})
    assert comparison.tested == tested
    assert comparison.ranking == ("B > A" if tested else "B, A")
    assert set(comparison.letters.values()) == ({"a", "b"} if tested else {""})


def test_there_are_no_letters_if_52_are_too_few() -> None:
    comparison = compare({str(n): [100.0 * n + i for i in range(300)] for n in range(60)})
    assert set(comparison.letters.values()) == {""}
    assert comparison.pair("59", "0").p < 1e-6


values = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=12)
groups = st.lists(values, min_size=2, max_size=5).map(lambda lists: dict(zip("ABCDE", lists, strict=False)))


class TestLaws:
    @given(groups, st.sampled_from(CORRECTIONS), st.randoms(use_true_random=False))
    def test_the_order_of_runs_and_groups_changes_nothing(
        self, given_groups: dict[str, list[float]], correction: str, chance: random.Random
    ) -> None:
        names = list(given_groups)
        chance.shuffle(names)
        shuffled = {name: chance.sample(given_groups[name], len(given_groups[name])) for name in names}
        one, other = compare(given_groups, correction), compare(shuffled, correction)  # type: ignore[arg-type]
        assert [group.name for group in one.groups] == [group.name for group in other.groups]
        assert one.h == pytest.approx(other.h, abs=1e-9)
        for pair in one.pairs:
            assert other.pair(pair.first, pair.second).p == pytest.approx(pair.p, abs=1e-9)
            assert other.pair(pair.first, pair.second).a12 == pytest.approx(pair.a12)

    @given(values, st.integers(2, 5))
    def test_identical_groups_are_tied(self, given_values: list[float], n: int) -> None:
        comparison = compare(dict.fromkeys("ABCDE"[:n], given_values), "none")
        assert comparison.p > 0.99
        few = len(given_values) < FEWEST
        assert set(comparison.letters.values()) == ({""} if few else {"a"})
        assert comparison.ranking == (", " if few else " = ").join("ABCDE"[:n])
        assert {pair.a12 for pair in comparison.pairs} == {0.5}

    @given(st.lists(st.floats(0, 1), min_size=10, max_size=30), st.floats(2, 100))
    def test_a_clear_shift_is_found(self, given_values: list[float], shift: float) -> None:
        comparison = compare({"low": given_values, "high": [value + shift for value in given_values]})
        assert comparison.ranking == "high > low"
        assert comparison.pair("high", "low").a12 == 1.0
        assert comparison.pair("low", "high").a12 == 0.0

    @given(groups, st.sampled_from(CORRECTIONS))
    def test_groups_are_sorted_by_mean_rank(
        self, given_groups: dict[str, list[float]], correction: str
    ) -> None:
        comparison = compare(given_groups, correction)  # type: ignore[arg-type]
        ranks = {group.name: group.mean_rank for group in comparison.groups}
        assert list(ranks.values()) == sorted(ranks.values(), reverse=True)
        for pair in comparison.pairs:
            assert pair.direction == np.sign(ranks[pair.first] - ranks[pair.second])
        assert "<" not in comparison.ranking

    @given(st.lists(st.floats(0, 100), min_size=2, max_size=6), st.sampled_from(CORRECTIONS))
    def test_groups_share_a_letter_if_and_only_if_they_are_not_different(
        self, places: list[float], correction: str
    ) -> None:
        spread = np.linspace(0, 40, 15)
        given_groups = {
            name: (place + spread).tolist() for name, place in zip("ABCDEF", places, strict=False)
        }
        comparison = compare(given_groups, correction)  # type: ignore[arg-type]
        for pair in comparison.pairs:
            shared = set(comparison.letters[pair.first]) & set(comparison.letters[pair.second])
            assert bool(shared) == (pair.p >= comparison.alpha)

    @given(values, values)
    def test_a12_counts_pairs(self, first: list[float], second: list[float]) -> None:
        wins = [1.0 if x > y else 0.5 if x == y else 0.0 for x, y in itertools.product(first, second)]
        assert a12(first, second) == pytest.approx(sum(wins) / len(wins))
        assert a12(first, second) + a12(second, first) == pytest.approx(1.0)

    @given(groups)
    def test_a_correction_never_decreases_p(self, given_groups: dict[str, list[float]]) -> None:
        raw = compare(given_groups, "none")
        for correction in CORRECTIONS:
            for pair in compare(given_groups, correction).pairs:
                assert pair.p >= raw.pair(pair.first, pair.second).p - 1e-12

    @given(st.floats(0.001, 1000), groups)
    def test_a_change_of_unit_keeps_the_statistic(
        self, unit: float, given_groups: dict[str, list[float]]
    ) -> None:
        changed = {
            name: [value * unit for value in given_values] for name, given_values in given_groups.items()
        }
        distinct = {v for given_values in given_groups.values() for v in given_values}
        assume(len({value * unit for value in distinct}) == len(distinct))
        assert compare(changed).h == pytest.approx(compare(given_groups).h)

    @given(st.integers(2, 1000), st.integers(1, 20))
    def test_more_runs_find_smaller_differences(self, n: int, comparisons: int) -> None:
        assert 0.5 < detectable_a12(n + 1, comparisons) <= detectable_a12(n, comparisons) <= 1.0
        assert detectable_a12(n, comparisons) <= detectable_a12(n, comparisons + 1)


def test_the_detectable_effect_is_that_of_noether() -> None:
    # Noether 1987, with equal groups: N = (z_a + z_b)^2 / (3 (A - 1/2)^2) values; two-sided 5 %, power 80 %.
    assert detectable_a12(30, 1) == pytest.approx(0.5 + (1.95996 + 0.84162) / np.sqrt(180), abs=1e-5)


@pytest.mark.parametrize(
    ("given_groups", "data"),
    [
        ({"a": [1.0]}, "found 1$"),
        ({"a": [1.0], "b": []}, "^b: "),
        ({"a": [1.0], "b": [float("nan")]}, "^b: "),
    ],
)
def test_values_that_cannot_be_compared_are_rejected(given_groups: dict[str, list[float]], data: str) -> None:
    with pytest.raises(ValueError, match=data):
        compare(given_groups)
