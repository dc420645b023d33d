"""What a comparison says, in words: also what it cannot say."""

from __future__ import annotations

from collections.abc import Sequence

from evoframe.analysis.statistics import Comparison, Pairwise, detectable_a12

__all__ = ["conclusion"]

_FEW = 10  # runs; below that a rank test of several groups finds next to nothing

_CORRECTIONS = {
    "holm": "corrected after Holm",
    "bonferroni": "corrected after Bonferroni",
    "fdr_bh": "corrected after Benjamini and Hochberg",
    "none": "not corrected for the number of pairs",
}


def conclusion(comparison: Comparison, measure: str) -> str:
    """Return a paragraph on what can and what cannot be concluded.

    Args:
        comparison: Of the groups.
        measure: What was compared, as ``the score of the best pair``.
    """
    return " ".join([_overall(comparison, measure), *_pairs(comparison), _limits(comparison)])


def _overall(comparison: Comparison, measure: str) -> str:
    found = "differs" if comparison.p < comparison.alpha else "is not found to differ"
    return (
        f"Between {_listed([group.name for group in comparison.groups])}, {measure} {found} as a whole "
        f"(Kruskal-Wallis, H = {comparison.h:.2f}, p {_p(comparison.p)}, "
        f"epsilon squared {comparison.epsilon_squared:.3f})."
    )


def _pairs(comparison: Comparison) -> list[str]:
    if comparison.p >= comparison.alpha:
        return ["So no pair of them should be called different, whatever a test of that pair alone says."]
    different = [pair for pair in comparison.pairs if pair.p < comparison.alpha]
    how = f"Dunn's test, {_CORRECTIONS[comparison.correction]}"
    if not different:
        return [f"Yet no pair of them can be told apart ({how})."]
    sentences = [f"{_greater(pair)} (p {_p(pair.p)})" for pair in different]
    rest = len(comparison.pairs) - len(different)
    others = f" The other {rest} pairs are not found to differ." if rest > 1 else ""
    if rest == 1:
        others = " The other pair is not found to differ."
    return [f"{_listed(sentences)} ({how}).{others}"]


def _greater(pair: Pairwise) -> str:
    first, second, share = pair.first, pair.second, pair.a12
    if share < 0.5:
        first, second, share = second, first, 1 - share
    return f"{first} beats {second} in {share:.0%} of all comparisons of two runs"


def _limits(comparison: Comparison) -> str:
    fewest = min(group.n for group in comparison.groups)
    found = detectable_a12(fewest, len(comparison.pairs), comparison.alpha)
    runs = f"{fewest} {'run' if fewest == 1 else 'runs'}"
    if fewest < _FEW:
        return f"With {runs} in the smallest group, a difference would have to be enormous to be found."
    return (
        f"With {runs} in the smallest group, a difference is found in four of five cases if one beats the "
        f"other in {found:.0%} of all comparisons of two runs; smaller ones cannot be excluded."
    )


def _p(p: float) -> str:
    return "< 0.001" if p < 0.001 else f"= {p:.3f}"


def _listed(items: Sequence[str]) -> str:
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"
