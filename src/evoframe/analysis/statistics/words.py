"""Written conclusions of a comparison, with their limits."""

from __future__ import annotations

from evoframe.analysis.output.texts import written
from evoframe.analysis.statistics.groups import FEWEST, Comparison, detectable_a12
from evoframe.analysis.statistics.pairs import orient

__all__ = ["conclusion"]

_FEW = 10  # values per group; with fewer, rank tests of several groups have little power
_MOST = 15  # pairs listed in a sentence


def conclusion(comparison: Comparison, measure: str, values: tuple[str, str] = ("run", "runs")) -> str:
    """Return a paragraph of conclusions, without p-values if the smallest group has fewer than five values.

    Args:
        comparison: The comparison.
        measure: The compared measure, as in ``the best fitness``.
        values: Noun for a value of a group, singular and plural.
    """
    smallest = min(group.n for group in comparison.groups)
    tests = 1 if comparison.correction == "none" else len(comparison.pairs)
    return written(
        "comparison.txt",
        comparison=comparison,
        measure=measure,
        one=values[0],
        several=values[1],
        different=[orient(pair) for pair in comparison.pairs if pair.p < comparison.alpha],
        most=_MOST,
        fewest=FEWEST,
        detectable=detectable_a12(smallest, tests, comparison.alpha) if smallest >= _FEW else None,
    )
