"""Conclusions of a measurement in words: also what cannot be concluded."""

from __future__ import annotations

from evoframe.analysis.output.texts import written
from evoframe.analysis.robustness.findings import Findings
from evoframe.analysis.statistics.blocks import BlockPair
from evoframe.analysis.statistics.groups import Comparison
from evoframe.analysis.statistics.pairs import oriented
from evoframe.analysis.statistics.words import conclusion

__all__ = ["conclusions"]

_ALPHA = 0.05
_MANY = 300  # controllers, with which one body that beats another with 58 % of them is found
_MOST = 10  # pairs, or names, that a reader follows
_FEWEST = 6  # controllers; whoever wins with all of 5 may do so by chance in 1 of 16 cases
_CONTROLLERS = ("controller", "controllers")
_BODIES = ("body", "bodies")


def conclusions(found: Findings) -> str:
    """Return paragraphs on what can and what cannot be concluded."""
    measured, groups = found.measured, found.measured.setting.groups
    alike: dict[str, list[str]] = {}
    for body in measured.setting.bodies:
        alike.setdefault(body.digest, []).append(body.label)
    apart, within, by_body = found.apart, found.within, found.by_body
    different = [pair for pair in within.pairs if pair.p < _ALPHA] if within else []
    groups_apart = apart.groups if apart else ()
    gap, closest = _smallest_gap(apart, different) if apart and by_body is None else (0.0, None)
    unit = measured.setting.unit
    text = written(
        "robustness.txt",
        measured=measured,
        controllers=_CONTROLLERS,
        twins=[labels for labels in alike.values() if len(labels) > 1],
        n_different=len(alike),
        lost={name: lost for name, columns in groups.items() if (lost := measured.lost(columns))},
        common=found.common,
        apart=apart,
        crooked=[group.name for group in groups_apart if (p := group.shapiro_p) is not None and p < _ALPHA],
        conclusion_apart=conclusion(apart, "the score", _CONTROLLERS) if apart else "",
        within=within,
        different=[*map(oriented, different)],
        closest=closest,
        gap=f"{1000 * gap:.3g} mm" if unit == "m" else f"{gap:.3g} {unit}".rstrip(),
        by_body=by_body,
        conclusion_by_body=conclusion(by_body, "the median of a body", _BODIES) if by_body else "",
        alone=[name for name, columns in groups.items() if len(columns) == 1],
        alpha=_ALPHA,
        many=_MANY,
        most=_MOST,
        fewest=_FEWEST,
    )
    return f"{text}\n"


def _smallest_gap(comparison: Comparison, pairs: list[BlockPair]) -> tuple[float, BlockPair | None]:
    """Return how far the medians of two different groups are apart at least, and which two these are."""
    medians = {group.name: group.median for group in comparison.groups}
    gaps = [(abs(medians[pair.first] - medians[pair.second]), pair) for pair in pairs]
    return min(gaps, key=lambda found: found[0], default=(0.0, None))
