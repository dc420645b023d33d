"""Words say what the numbers say."""

from __future__ import annotations

import re

import numpy as np

from evoframe.analysis.statistics.groups import compare
from evoframe.analysis.statistics.words import conclusion

RNG = np.random.default_rng(1)
NOISE = [RNG.normal(0, 1, 30).tolist() for _ in range(3)]


def test_groups_that_are_alike() -> None:
    words = conclusion(compare(dict(zip(("AM", "WM", "GM"), NOISE, strict=True))), "the score")
    assert words.startswith("Between ")
    assert "the score is not found to differ as a whole (Kruskal-Wallis, H = " in words
    assert "No pair of them can be told apart by Dunn's test, corrected after Holm." in words
    assert (
        "With 30 runs in the smallest group, a difference is found in four of five cases if one is the "
        "greater in 74% of" in words
    )
    assert "smaller ones cannot be excluded." in words


def test_groups_that_differ() -> None:
    shifted = [[value + 100 * place for value in NOISE[place]] for place in range(3)]
    words = conclusion(compare(dict(zip(("AM", "WM", "GM"), shifted, strict=True))), "the score")
    assert words.startswith(
        "Between GM, WM and AM, the score differs as a whole (Kruskal-Wallis, H = 79.12, p < 0.001"
    )
    assert "GM is above AM (the greater in 100% of all comparisons of two runs, p < 0.001)" in words
    assert ", by Dunn's test, corrected after Holm; ties count half." in words
    assert "not found to differ" not in words


def test_one_that_differs_from_two_that_do_not() -> None:
    groups = {"AM": NOISE[0], "WM": NOISE[1], "GM": [value - 100 for value in NOISE[2]]}
    words = conclusion(compare(groups, "none"), "the score")
    assert "AM is above GM (the greater in 100% of" in words
    assert ", by Dunn's test, not corrected for the number of pairs; ties count half. The other pair" in words
    assert "if one is the greater in 71% of" in words  # without a correction


def test_pairs_that_differ_alone_are_weak_evidence() -> None:
    low, high = [float(value) for value in range(5)], [float(value) for value in range(3, 8)]
    comparison = compare({"A": low, "B": high, "C": [2.5, 3.5, 4.5], "D": [2.6, 3.6, 4.6]}, "none")
    assert comparison.p > 0.05 > comparison.pair("A", "B").p
    words = conclusion(comparison, "the score")
    assert "B is above A (" in words
    assert "Without a correction, 5% of all pairs that are alike are found to differ." in words
    assert "As all groups together are not found to differ, this is weak evidence." in words


def test_many_groups_are_not_listed_pair_by_pair() -> None:
    words = conclusion(compare({f"G{n}": [value + 100 * n for value in NOISE[0]] for n in range(9)}), "it")
    assert re.search(r"\d\d of 36 pairs differ by Dunn's test, corrected after Holm; the tables name", words)


def test_values_need_not_be_of_runs() -> None:
    words = conclusion(compare({"AM": NOISE[0], "WM": NOISE[1]}), "the score", ("body", "bodies"))
    assert "With 30 bodies in the smallest group" in words
    assert "all comparisons of two bodies; smaller ones cannot be excluded." in words
    assert "run" not in words


def test_too_few_runs() -> None:
    words = conclusion(compare({"AM": [1.0], "WM": [2.0, 3.0]}), "the score")
    assert words.endswith(
        "With 1 run in the smallest group these tests, whose p-values suppose more of them, show nothing, "
        "and exclude nothing."
    )
    words = conclusion(compare({"AM": [1.0] * 5, "WM": [2.0, 3.0, 4.0, 5.0, 6.0]}), "the score")
    assert words.endswith(
        "With 5 runs in the smallest group, a difference would have to be enormous to be found."
    )


def test_a_few_values_of_one_group_do_not_spoil_the_others() -> None:
    groups = {"AM": NOISE[0], "WM": [value + 100 for value in NOISE[1]], "GM": NOISE[2][:2], "HM": [1.0]}
    words = conclusion(compare(groups), "the score")
    assert "WM is above AM (" in words
    assert "Of HM and GM, with fewer than 5 runs, nothing is shown." in words
    assert "With 30 runs in the smallest of the others, a difference is found in four of five cases" in words
    assert "show nothing, and exclude nothing" not in words
