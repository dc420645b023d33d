"""The tables of a study, for a spreadsheet and for an article."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import pandas as pd

from evoframe.analysis.corrections import Correction
from evoframe.analysis.statistics import Comparison, compare
from evoframe.analysis.study_data import YARDSTICKS, StudyData, View, Yardstick
from evoframe.provenance import leaves
from evoframe.verification import Verification

__all__ = [
    "comparisons",
    "pairs_table",
    "ranking_table",
    "summary_table",
    "verification_table",
    "versions_table",
]

Compared: TypeAlias = list[tuple[View, Yardstick, Comparison]]


def comparisons(data: StudyData, correction: Correction = "holm") -> Compared:
    """Return the comparison of each view on each yardstick, where it has two groups or more."""
    return [
        (view, yardstick, compare(view.values(yardstick), correction))
        for yardstick in YARDSTICKS
        for view in data.views(yardstick)
        if len(view.groups) > 1
    ]


def summary_table(found: Compared) -> pd.DataFrame:
    """Return a line for each group: how its values lie, and its letters."""
    return pd.DataFrame(
        [
            {
                "view": view.title,
                "yardstick": yardstick,
                "group": group.name,
                "runs": group.n,
                "mean rank": group.mean_rank,
                "mean": group.mean,
                "sd": group.sd,
                "median": group.median,
                "first quartile": group.quartiles[0],
                "third quartile": group.quartiles[1],
                "Shapiro-Wilk p": group.shapiro_p,
                "letters": comparison.letters[group.name],
            }
            for view, yardstick, comparison in found
            for group in comparison.groups
        ]
    )


def pairs_table(found: Compared) -> pd.DataFrame:
    """Return a line for each pair of groups: Dunn's p, and how often the first wins."""
    return pd.DataFrame(
        [
            {
                "view": view.title,
                "yardstick": yardstick,
                "first": pair.first,
                "second": pair.second,
                "Dunn p": pair.p,
                "correction": comparison.correction,
                "A12": pair.a12,
            }
            for view, yardstick, comparison in found
            for pair in comparison.pairs
        ]
    )


def ranking_table(found: Compared) -> pd.DataFrame:
    """Return a line for each view and yardstick: Kruskal-Wallis, and the ranking in the paper's notation."""
    return pd.DataFrame(
        [
            {
                "view": view.title,
                "yardstick": yardstick,
                "ranking": comparison.ranking,
                "Kruskal-Wallis H": comparison.h,
                "p": comparison.p,
                "epsilon squared": comparison.epsilon_squared,
            }
            for view, yardstick, comparison in found
        ]
    )


def verification_table(verification: Verification) -> pd.DataFrame:
    """Return a line for each change: the median score with it, and its part of the unchanged score."""
    return pd.DataFrame(
        [
            {
                "variant": finding.name,
                f"median ({verification.unit or 1})": finding.median,
                "of unchanged": verification.share(finding),
                "draws": len(finding.scores),
                "diverged": len(finding.diverged_at),
            }
            for finding in verification.rows
        ]
    )


def versions_table(provenance: Mapping[str, Any]) -> pd.DataFrame:
    """Return a line for each thing that a run says it was made by; none if it says nothing."""
    found = [
        (key, ", ".join(map(str, value)) if isinstance(value, list) else str(value))
        for key, value in (leaves(provenance) if provenance else ())
    ]
    return pd.DataFrame(found, columns=["what", "which"])
