"""The tables of a study, for a spreadsheet and for an article."""

from __future__ import annotations

import itertools

import pandas as pd

from evoframe.analysis.figures import final_values
from evoframe.analysis.statistics import Comparison, Correction, compare
from evoframe.analysis.study_data import YARDSTICKS, StudyData, Yardstick

__all__ = ["comparisons", "pairs_table", "ranking_table", "summary_table"]

Panel = dict[str, str]
Compared = list[tuple[Panel, Yardstick, Comparison]]


def comparisons(data: StudyData, correction: Correction = "holm") -> Compared:
    """Return the comparison of each panel on each yardstick, where it has two groups or more."""
    found: Compared = []
    for panel, yardstick in itertools.product(data.panels, YARDSTICKS):
        values = final_values(data.of(panel), yardstick)
        if len(values) > 1:
            found.append((panel, yardstick, compare(values, correction)))
    return found


def summary_table(found: Compared) -> pd.DataFrame:
    """Return a line for each group: how its values lie, and its letters."""
    return pd.DataFrame(
        [
            {
                **panel,
                "yardstick": yardstick,
                "group": group.name,
                "runs": group.n,
                "mean": group.mean,
                "sd": group.sd,
                "median": group.median,
                "first quartile": group.quartiles[0],
                "third quartile": group.quartiles[1],
                "Shapiro-Wilk p": group.shapiro_p,
                "letters": comparison.letters[group.name],
            }
            for panel, yardstick, comparison in found
            for group in comparison.groups
        ]
    )


def pairs_table(found: Compared) -> pd.DataFrame:
    """Return a line for each pair of groups: Dunn's p, and how often the first wins."""
    return pd.DataFrame(
        [
            {
                **panel,
                "yardstick": yardstick,
                "first": pair.first,
                "second": pair.second,
                "Dunn p": pair.p,
                "correction": comparison.correction,
                "A12": pair.a12,
            }
            for panel, yardstick, comparison in found
            for pair in comparison.pairs
        ]
    )


def ranking_table(found: Compared) -> pd.DataFrame:
    """Return a line for each panel and yardstick: Kruskal-Wallis, and the ranking in the paper's notation."""
    return pd.DataFrame(
        [
            {
                **panel,
                "yardstick": yardstick,
                "Kruskal-Wallis H": comparison.h,
                "p": comparison.p,
                "epsilon squared": comparison.epsilon_squared,
                "ranking": comparison.ranking,
            }
            for panel, yardstick, comparison in found
        ]
    )
