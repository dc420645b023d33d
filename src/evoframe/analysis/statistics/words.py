"""Conclusions of a comparison in words: also what cannot be concluded."""

from __future__ import annotations

from evoframe.analysis.output.texts import written
from evoframe.analysis.statistics.groups import FEWEST, Comparison, detectable_a12
from evoframe.analysis.statistics.pairs import oriented

__all__ = ["conclusion"]

_FEW = 10  # values; below that a rank test of several groups finds next to nothing
_MOST = 15  # pairs that a reader follows


def conclusion(comparison: Comparison, measure: str, values: tuple[str, str] = ("run", "runs")) -> str:
    """Return a paragraph on what can and what cannot be concluded.

    Args:
        comparison: Of the groups.
        measure: What was compared, as ``the score of the best pair``.
        values: What each value of a group is of: one of them, several of them.
    """
    enough = [group.n for group in comparison.groups if group.n >= FEWEST]
    tests = 1 if comparison.correction == "none" else len(comparison.pairs)
    sensitive = min(enough, default=0) >= _FEW
    return written(
        "comparison.txt",
        comparison=comparison,
        measure=measure,
        one=values[0],
        several=values[1],
        different=[oriented(pair) for pair in comparison.pairs if pair.p < comparison.alpha],
        most=_MOST,
        few=[group.name for group in comparison.groups if group.n < FEWEST],
        fewest=FEWEST,
        enough=enough,
        detectable=detectable_a12(min(enough), tests, comparison.alpha) if sensitive else None,
    )
