"""What a comparison says, in words: also what it cannot say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.groups import FEWEST, Comparison, Pairwise, detectable_a12
from evoframe.analysis.statistics.pairs import oriented

__all__ = ["conclusion", "corrected", "counted", "in_words", "listed"]

_FEW = 10  # values; below that a rank test of several groups finds next to nothing
_MOST = 15  # pairs that a reader follows

_CORRECTIONS = {
    "holm": "corrected after Holm",
    "bonferroni": "corrected after Bonferroni",
    "fdr_bh": "corrected after Benjamini and Hochberg",
    "none": "not corrected for the number of pairs",
}


def conclusion(comparison: Comparison, measure: str, values: tuple[str, str] = ("run", "runs")) -> str:
    """Return a paragraph on what can and what cannot be concluded.

    Args:
        comparison: Of the groups.
        measure: What was compared, as ``the score of the best pair``.
        values: What each value of a group is of: one of them, several of them.
    """
    parts = [_overall(comparison, measure), *_pairs(comparison, values[1]), _limits(comparison, values)]
    return " ".join(parts)


def _overall(comparison: Comparison, measure: str) -> str:
    found = "differs" if comparison.p < comparison.alpha else "is not found to differ"
    return (
        f"Between {listed([group.name for group in comparison.groups])}, {measure} {found} as a whole "
        f"(Kruskal-Wallis, H = {comparison.h:.2f}, p {in_words(comparison.p)}, "
        f"epsilon squared {comparison.epsilon_squared:.3f})."
    )


def _pairs(comparison: Comparison, values: str) -> list[str]:
    different = [pair for pair in comparison.pairs if pair.p < comparison.alpha]
    how = f"Dunn's test, {corrected(comparison.correction)}"
    if not different:
        return [f"No pair of them can be told apart by {how}."]
    if len(different) > _MOST:
        return [
            f"{len(different)} of {len(comparison.pairs)} pairs differ by {how}; the tables name them.",
            *_doubts(comparison),
        ]
    sentences = [_greater(oriented(pair), values) for pair in different]
    rest = len(comparison.pairs) - len(different)
    others = f" The other {rest} pairs are not found to differ." if rest > 1 else ""
    if rest == 1:
        others = " The other pair is not found to differ."
    return [f"{listed(sentences)}, by {how}; ties count half.{others}", *_doubts(comparison)]


def _doubts(comparison: Comparison) -> Iterator[str]:
    """Say what speaks against pairs that were found to differ."""
    if comparison.correction == "none" and len(comparison.pairs) > 1:
        yield f"Without a correction, {comparison.alpha:.0%} of all pairs that are alike are found to differ."
    if comparison.p >= comparison.alpha:
        yield "As all groups together are not found to differ, this is weak evidence."


def corrected(correction: Correction) -> str:
    """Return in words how p-values of pairs are corrected."""
    return _CORRECTIONS[correction]


def _greater(pair: Pairwise, values: str) -> str:
    often = f"the greater in {pair.a12:.0%} of all comparisons of two {values}"
    return f"{pair.first} is above {pair.second} ({often}, p {in_words(pair.p)})"


def _limits(comparison: Comparison, values: tuple[str, str]) -> str:
    few = [group.name for group in comparison.groups if group.n < FEWEST]
    enough = [group.n for group in comparison.groups if group.n >= FEWEST]
    if len(enough) < 2:
        count = counted(min(group.n for group in comparison.groups), *values)
        return (
            f"With {count} in the smallest group these tests, whose p-values suppose more of them, show "
            "nothing, and exclude nothing."
        )
    if not few:
        return _found(comparison, min(enough), values, "in the smallest group")
    found = _found(comparison, min(enough), values, "in the smallest of the others")
    return f"Of {listed(few)}, with fewer than {FEWEST} {values[1]}, nothing is shown. {found}"


def _found(comparison: Comparison, fewest: int, values: tuple[str, str], where: str) -> str:
    """Say what can be found with so few values."""
    count = counted(fewest, *values)
    if fewest < _FEW:
        return f"With {count} {where}, a difference would have to be enormous to be found."
    tests = 1 if comparison.correction == "none" else len(comparison.pairs)
    found = detectable_a12(fewest, tests, comparison.alpha)
    return (
        f"With {count} {where}, a difference is found in four of five cases if one is the greater in "
        f"{found:.0%} of all comparisons of two {values[1]}; smaller ones cannot be excluded."
    )


def counted(count: int, one: str, several: str) -> str:
    """Return a number with what it is of, as in ``1 run`` and ``2 runs``."""
    return f"{count} {one if count == 1 else several}"


def in_words(p: float) -> str:
    """Return what stands after a p: how small it is."""
    return "< 0.001" if p < 0.001 else f"= {p:.3f}"


def listed(items: Sequence[str]) -> str:
    """Return items as a list within a sentence."""
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"
