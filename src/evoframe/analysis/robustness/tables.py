"""Tables of a measurement."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from evoframe.analysis.data.units import axis_title
from evoframe.analysis.output.latex import decimals, fixed, p_cell, quartiles_cell
from evoframe.analysis.robustness.findings import Findings
from evoframe.analysis.statistics.blocks import BlockComparison
from evoframe.analysis.statistics.groups import Comparison
from evoframe.analysis.statistics.pairs import Pair
from evoframe.messages import unit_factor
from evoframe.robustness import Robustness

__all__ = [
    "SCORES",
    "bodies_article",
    "bodies_table",
    "groups_article",
    "groups_table",
    "pairs_article",
    "pairs_table",
    "ranking_article",
    "ranking_table",
]

SCORES = ("median", "first quartile", "third quartile", "least", "greatest")
"""Columns of the tables of groups and bodies that are in the unit of the scores."""

_SPREAD = (*SCORES, "positive")
_PAIRS = (
    *("first", "second", "correction", "Dunn p", "A12", "Wilcoxon p", "wins"),
    *("Dunn p by body", "A12 by body"),
)
_RANKING = ("compared", "test", "statistic", "p", "effect size", "effect", "ranking")


def groups_table(found: Findings) -> pd.DataFrame:
    """Return a line for each group: statistics of its scores, Shapiro-Wilk's p, and letters of Dunn's test.

    ``positive`` is the share of scores above 0. Shapiro-Wilk tests the values that Dunn's test compares: one
    per controller.
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
    """Return a line for each body: statistics of its scores."""
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

    ``A12`` is the probability that the first group scores higher if controllers are drawn independently,
    ``wins`` if both groups have the same controller. ``A12 by body`` is the probability that a body of the
    first group has the greater median.
    Groups of fewer than five values have no p-values.
    """
    if found.apart is None or found.within is None:
        return pd.DataFrame(columns=[*_PAIRS])
    rows = []
    for pair in found.apart.pairs:
        block = found.within.pair(pair.first, pair.second)
        by_body = None if found.by_body is None else found.by_body.pair(pair.first, pair.second)
        own = (None, None) if by_body is None else (_p_of(by_body, found.by_body), by_body.a12)
        names = (pair.first, pair.second, found.apart.correction)
        p, p_within = _p_of(pair, found.apart), _p_of(block, found.within)
        rows.append((*names, p, pair.a12, p_within, block.wins, *own))
    return pd.DataFrame(rows, columns=[*_PAIRS])


def ranking_table(found: Findings) -> pd.DataFrame:
    """Return a line for each comparison of all groups: its test, effect size, and ranking."""
    rows: list[tuple[Any, ...]] = []
    for what, whole in (("independent controllers", found.apart), ("medians of bodies", found.by_body)):
        if whole is not None:
            test = ("Kruskal-Wallis", whole.h, whole.p) if whole.tested else (None, None, None)
            rows.append((what, *test, "epsilon squared", whole.epsilon_squared, whole.ranking))
    if found.within is not None:
        blocks, two = found.within, found.within.kendall_w is None
        effect = ("wins", blocks.pairs[0].wins) if two else ("Kendall's W", blocks.kendall_w)
        name = "Wilcoxon" if two else "Friedman"
        within = (name, blocks.chi_squared, blocks.p) if blocks.tested else (None, None, None)
        rows.insert(1, ("within controllers", *within, *effect, blocks.ranking()))
    return pd.DataFrame(rows, columns=[*_RANKING])


def groups_article(found: Findings) -> pd.DataFrame:
    """Return the table of groups for an article: medians, quartiles and letters."""
    return _article(groups_table(found), ["group", "bodies"], ["diverged", "letters"], found.measured)


def bodies_article(measured: Robustness) -> pd.DataFrame:
    """Return the table of bodies for an article: medians and quartiles."""
    return _article(bodies_table(measured), ["body", "group"], ["diverged"], measured)


def pairs_article(found: Findings) -> pd.DataFrame:
    """Return the table of pairs for an article: p-values and effect sizes across and within controllers."""
    table = pairs_table(found)
    return pd.DataFrame(
        {
            "first": table["first"],
            "second": table["second"],
            "Dunn p": [*map(_p_text, table["Dunn p"])],
            "A12": [f"{value:.2f}" for value in table["A12"]],
            "Wilcoxon p": [*map(_p_text, table["Wilcoxon p"])],
            "wins": [f"{value:.2f}" for value in table["wins"]],
        }
    )


def ranking_article(found: Findings) -> pd.DataFrame:
    """Return the table of rankings for an article."""
    table = ranking_table(found)
    return pd.DataFrame(
        {
            "ranking": [
                f"{compared}: {ranking}"
                for compared, ranking in zip(table["compared"], table["ranking"], strict=True)
            ],
            "test": ["-" if pd.isna(name) else name for name in table["test"]],
            "p": [*map(_p_text, table["p"])],
        }
    )


def _article(table: pd.DataFrame, names: list[str], more: list[str], measured: Robustness) -> pd.DataFrame:
    """Return *names*, medians, quartiles and *more* of a table, rounded by their standard error."""
    unit = measured.setting.unit
    factor = unit_factor(unit)
    spread = table[["median", "first quartile", "third quartile"]].astype(float) * factor
    error = (spread["third quartile"] - spread["first quartile"]) / math.sqrt(measured.setting.controllers)
    places = decimals(error)
    known = spread["median"].notna()
    medians = [
        fixed(value, places) if there else "-" for value, there in zip(spread["median"], known, strict=True)
    ]
    quartiles = [
        quartiles_cell(low, high, places) if there else "-"
        for low, high, there in zip(spread["first quartile"], spread["third quartile"], known, strict=True)
    ]
    shown = {axis_title("median", unit): medians, axis_title("quartiles", unit): quartiles}
    return pd.DataFrame({**table[names], **shown, **table[more]})


def _p_text(p: float | None) -> str:
    return p_cell(None if pd.isna(p) else p)


def _p_of(pair: Pair, whole: Comparison | BlockComparison | None) -> float | None:
    """Return the p-value of a pair; ``None`` if the groups are too small for tests."""
    return pair.p if whole is not None and whole.tested else None


def _spread(measured: Robustness, columns: Sequence[int]) -> dict[str, float | None]:
    """Return statistics of scores; ``None`` if all simulations diverged."""
    values = measured.values(columns)
    if not len(values):
        return dict.fromkeys(_SPREAD)
    low, middle, high = np.quantile(values, [0.25, 0.5, 0.75])
    figures = (middle, low, high, values.min(), values.max(), np.mean(values > 0))
    return dict(zip(_SPREAD, map(float, figures), strict=True))
