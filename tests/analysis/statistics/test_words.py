"""Tests of written conclusions: their numbers are those of the comparison."""

from __future__ import annotations

import re

import numpy as np
import pytest

from evoframe.analysis.statistics.groups import Comparison, compare, detectable_a12
from evoframe.analysis.statistics.words import conclusion

RNG = np.random.default_rng(1)
NOISE = [RNG.normal(0, 1, 30).tolist() for _ in range(3)]


def pairs_in(words: str) -> list[tuple[str, ...]]:
    """Return the pairs that the words call different, with their A12 and p."""
    return re.findall(r"(\w+) exceeds (\w+) \(A12 = ([\d.]+), p ([<=] [\d.]+)\)", words)


def sentences(words: str) -> int:
    return len(re.findall(r"[.](?: |$)", words))


def has_whole(words: str, comparison: Comparison) -> bool:
    """Return whether the words have the statistics of the test of all groups."""
    numbers = (
        f"H = {comparison.h:.2f}, p",
        f"epsilon squared = {comparison.epsilon_squared:.3f}",
        *(group.name for group in comparison.groups),
    )
    return all(number in words for number in numbers)


def test_groups_that_are_alike() -> None:
    comparison = compare(dict(zip(("AM", "WM", "GM"), NOISE, strict=True)))
    words = conclusion(comparison, "the score")
    assert words.startswith("The score does not differ ")
    assert has_whole(words, comparison)
    assert pairs_in(words) == []
    assert "Holm" in words
    assert "30 runs" in words
    assert f"A12 >= {detectable_a12(30, 3):.2f}" in words


def test_groups_that_differ() -> None:
    shifted = [[value + 100 * place for value in NOISE[place]] for place in range(3)]
    comparison = compare(dict(zip(("AM", "WM", "GM"), shifted, strict=True)))
    words = conclusion(comparison, "the score")
    assert words.startswith("The score differs ")
    assert has_whole(words, comparison)
    assert "H = 79.12, p < 0.001" in words
    assert {pair[:3] for pair in pairs_in(words)} == {
        ("GM", "WM", "1.00"), ("GM", "AM", "1.00"), ("WM", "AM", "1.00"),
    }  # fmt: skip
    assert "not differ" not in words


def test_one_group_that_differs_from_two_that_do_not() -> None:
    groups = {"AM": NOISE[0], "WM": NOISE[1], "GM": [value - 100 for value in NOISE[2]]}
    words = conclusion(compare(groups, "none"), "the score")
    assert {pair[:3] for pair in pairs_in(words)} == {("AM", "GM", "1.00"), ("WM", "GM", "1.00")}
    assert "no correction" in words
    assert "The other pair" in words
    assert f"A12 >= {detectable_a12(30, 1):.2f}" in words  # without a correction


def test_pairwise_differences_without_a_difference_of_all_groups_are_qualified() -> None:
    low, high = [float(value) for value in range(5)], [float(value) for value in range(3, 8)]
    middle = [2.5, 3.0, 3.5, 4.0, 4.5]
    groups = {"A": low, "B": high, "C": middle, "D": [value + 0.1 for value in middle]}
    comparison = compare(groups, "none")
    assert comparison.p > 0.05 > comparison.pair("A", "B").p
    words = conclusion(comparison, "the score")
    assert ("B", "A") in {pair[:2] for pair in pairs_in(words)}
    assert "5%" in words
    assert "weak evidence" in words


def test_many_groups_are_not_listed_pair_by_pair() -> None:
    words = conclusion(compare({f"G{n}": [value + 100 * n for value in NOISE[0]] for n in range(9)}), "it")
    assert re.search(r"\d\d of 36 ", words)
    assert "pairs.csv" in words
    assert pairs_in(words) == []


def test_the_noun_of_values_can_be_chosen() -> None:
    groups = {"AM": NOISE[0], "WM": [value + 100 for value in NOISE[1]]}
    words = conclusion(compare(groups), "the score", ("body", "bodies"))
    assert "30 bodies" in words
    assert "pair of bodies" in words
    assert "run" not in words


@pytest.mark.parametrize(("runs", "smallest"), [(1, "1 run "), (4, "4 runs ")])
def test_small_groups_get_one_sentence_and_no_p_value(runs: int, smallest: str) -> None:
    groups = {"AM": NOISE[0], "WM": [value + 100 for value in NOISE[1]], "GM": NOISE[2][:runs]}
    words = conclusion(compare(groups), "the score")
    assert smallest in words
    assert "at least 5 runs" in words
    assert not re.search(r"\bp [<=>]|H =|A12|power", words)
    assert sentences(words) == 2  # the order of the groups, and the reason


def test_five_runs_are_tested_but_detect_little() -> None:
    words = conclusion(compare({"AM": [1.0] * 5, "WM": [2.0, 3.0, 4.0, 5.0, 6.0]}), "the score")
    assert pairs_in(words) == [("WM", "AM", "1.00", "= 0.005")]
    assert "5 runs" in words
    assert "power" not in words
