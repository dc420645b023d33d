"""The tables of a measurement, for a spreadsheet and for an article."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from evoframe.analysis.robustness.findings import Findings
from evoframe.robustness import Robustness

__all__ = ["bodies_table", "groups_table", "pairs_table", "ranking_table"]

_SPREAD = ("median", "first quartile", "third quartile", "least", "greatest", "positive")
_PAIRS = (
    *("first", "second", "correction", "Dunn p", "A12", "Wilcoxon p", "wins"),
    *("Dunn p by body", "A12 by body"),
)
_RANKING = ("compared", "test", "statistic", "p", "effect size", "effect", "ranking")


def groups_table(found: Findings) -> pd.DataFrame:
    """Return a line for each group: how the scores of its bodies lie, Shapiro-Wilk's p and Dunn's letters.

    ``positive`` is the share of scores above 0. Shapiro-Wilk judges what Dunn compares: one value for each
    controller.
    """
    apart = {} if found.apart is None else {group.name: group for group in found.apart.groups}
    letters = {} if found.apart is None else found.apart.letters
    return pd.DataFrame(
        [
            {
                "group": name,
                "bodies": len(columns),
                **_spread(found.measured, columns),
                "diverged": found.measured.lost(columns),
                "Shapiro-Wilk p": apart[name].shapiro_p if name in apart else None,
                "letters": letters.get(name, ""),
            }
            for name, columns in found.measured.setting.groups.items()
        ]
    )


def bodies_table(measured: Robustness) -> pd.DataFrame:
    """Return a line for each body: how its scores lie."""
    return pd.DataFrame(
        [
            {
                "body": body.label,
                "group": body.group,
                **_spread(measured, [column]),
                "diverged": measured.lost([column]),
                "digest": body.digest[:16],
            }
            for column, body in enumerate(measured.setting.bodies)
        ]
    )


def pairs_table(found: Findings) -> pd.DataFrame:
    """Return a line for each pair of groups.

    ``A12`` is how often the first wins if both are given any controller, ``wins`` how often if both are given
    the same one, and ``A12 by body`` how often a body of the first has the greater median.
    """
    if found.apart is None or found.within is None:
        return pd.DataFrame(columns=[*_PAIRS])
    rows = []
    for pair in found.apart.pairs:
        block = found.within.pair(pair.first, pair.second)
        by_body = None if found.by_body is None else found.by_body.pair(pair.first, pair.second)
        own = (None, None) if by_body is None else (by_body.p, by_body.a12)
        names = (pair.first, pair.second, found.apart.correction)
        rows.append((*names, pair.p, pair.a12, block.p, block.wins, *own))
    return pd.DataFrame(rows, columns=[*_PAIRS])


def ranking_table(found: Findings) -> pd.DataFrame:
    """Return a line for each way to compare all groups: its test, effect size, and ranking."""
    rows: list[tuple[Any, ...]] = []
    for what, whole in (("each controller for itself", found.apart), ("medians of bodies", found.by_body)):
        if whole is not None:
            share = whole.epsilon_squared
            rows.append((what, "Kruskal-Wallis", whole.h, whole.p, "epsilon squared", share, whole.ranking))
    if found.within is not None:
        blocks, two = found.within, found.within.kendall_w is None
        effect = ("wins", blocks.pairs[0].wins) if two else ("Kendall's W", blocks.kendall_w)
        test = "Wilcoxon" if two else "Friedman"
        rows.insert(1, ("within controllers", test, blocks.chi_squared, blocks.p, *effect, blocks.ranking()))
    return pd.DataFrame(rows, columns=[*_RANKING])


def _spread(measured: Robustness, columns: Sequence[int]) -> dict[str, float | None]:
    """Return how scores lie; ``None`` if all simulations diverged."""
    values = measured.values(columns)
    if not len(values):
        return dict.fromkeys(_SPREAD)
    low, middle, high = np.quantile(values, [0.25, 0.5, 0.75])
    figures = (middle, low, high, values.min(), values.max(), np.mean(values > 0))
    return dict(zip(_SPREAD, map(float, figures), strict=True))
