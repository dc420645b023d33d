"""Written conclusions of a measurement, with their limits."""

from __future__ import annotations

from evoframe.analysis.output.texts import written
from evoframe.analysis.robustness.findings import Findings
from evoframe.analysis.statistics.blocks import BlockPair
from evoframe.analysis.statistics.groups import FEWEST, Comparison
from evoframe.analysis.statistics.pairs import orient
from evoframe.analysis.statistics.words import conclusion
from evoframe.messages import quantity

__all__ = ["conclusions"]

_ALPHA = 0.05
_MANY = 300  # controllers with which Wilcoxon's test detects a body that wins with 58 % of them
_MOST = 10  # pairs or names listed in a sentence
_FEWEST_PAIRS = 6  # controllers; a body wins or loses with all of 5 by chance in 1 of 16 cases
_CONTROLLERS, _RANDOM = ("controller", "controllers"), ("random controller", "random controllers")
_BODIES = ("body", "bodies")


def conclusions(found: Findings) -> str:
    """Return the paragraphs of conclusions, with their limits."""
    measured, groups = found.measured, found.measured.setting.groups
    alike: dict[str, list[str]] = {}
    for body in measured.setting.bodies:
        alike.setdefault(body.digest, []).append(body.label)
    apart, within, by_body = found.apart, found.within, found.by_body
    different = [pair for pair in within.pairs if pair.p < _ALPHA] if within and within.tested else []
    groups_apart = apart.groups if apart else ()
    gap, closest = _smallest_gap(apart, different) if apart and by_body is None else (0.0, None)
    unit = measured.setting.unit
    text = written(
        "robustness.txt",
        measured=measured,
        controllers=_CONTROLLERS,
        random_controllers=_RANDOM,
        twins=[labels for labels in alike.values() if len(labels) > 1],
        n_different=len(alike),
        lost={name: lost for name, columns in groups.items() if (lost := measured.lost(columns))},
        common=found.common,
        apart=apart,
        crooked=[group.name for group in groups_apart if (p := group.shapiro_p) is not None and p < _ALPHA],
        conclusion_apart=conclusion(apart, "the score", _CONTROLLERS) if apart else "",
        within=within,
        different=[*map(orient, different)],
        closest=closest,
        gap=quantity(gap, unit, digits=3),
        by_body=by_body,
        conclusion_by_body=conclusion(by_body, "the median of a body", _BODIES) if by_body else "",
        alone=[name for name, columns in groups.items() if len(columns) == 1],
        alpha=_ALPHA,
        many=_MANY,
        most=_MOST,
        fewest=FEWEST,
        fewest_pairs=_FEWEST_PAIRS,
    )
    return f"{text}\n"


def _smallest_gap(comparison: Comparison, pairs: list[BlockPair]) -> tuple[float, BlockPair | None]:
    """Return the smallest distance between the medians of a pair, and the pair, if there is one."""
    medians = {group.name: group.median for group in comparison.groups}
    gaps = [(abs(medians[pair.first] - medians[pair.second]), pair) for pair in pairs]
    return min(gaps, key=lambda found: found[0], default=(0.0, None))
