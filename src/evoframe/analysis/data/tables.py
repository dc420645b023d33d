"""Tables of studies, verifications and versions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import pandas as pd

from evoframe.analysis.data.studies import YARDSTICKS, StudyData, View, Yardstick
from evoframe.analysis.data.units import NAMES, axis_title, in_unit
from evoframe.analysis.output.latex import decimals, fixed, p_cell, quartiles_cell
from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.groups import Comparison, Group, compare, ranked
from evoframe.documents import leaves
from evoframe.messages import unit_factor
from evoframe.record import Verification

__all__ = [
    "Compared",
    "comparisons",
    "pairs_article",
    "pairs_table",
    "ranking_article",
    "ranking_table",
    "summary_article",
    "summary_table",
    "verification_table",
    "versions_table",
]

_WHERE = ("view", "yardstick")


@attrs.frozen
class Compared:
    """A view compared on one yardstick.

    Attributes:
        view: The groups of runs.
        yardstick: The compared measure.
        groups: Descriptive statistics of each group.
        comparison: Comparison of the groups; ``None`` for a single group, or if each group has one run.
    """

    view: View
    yardstick: Yardstick
    groups: tuple[Group, ...]
    comparison: Comparison | None

    @property
    def where(self) -> dict[str, str]:
        """The cells that identify the comparison in a row of a table."""
        return {"view": self.view.title, "yardstick": self.yardstick}

    @property
    def heading(self) -> str:
        """The heading of the comparison in an article's table."""
        return f"{self.view.title}, {NAMES[self.yardstick]}"


def comparisons(data: StudyData, correction: Correction = "holm") -> list[Compared]:
    """Compare the groups of each view on each yardstick."""
    found = []
    for yardstick in YARDSTICKS:
        for view in data.views(yardstick):
            values = view.values(yardstick)
            testable = len(values) > 1 and max(map(len, values.values())) > 1
            comparison = compare(values, correction) if testable else None
            groups = comparison.groups if comparison else ranked(values)
            found.append(Compared(view, yardstick, groups, comparison))
    return found


def summary_table(found: Sequence[Compared], unit: str = "") -> pd.DataFrame:
    """Return a line for each group: its descriptive statistics and its letters."""
    table = pd.DataFrame(
        [
            {
                **each.where,
                "group": group.name,
                "runs": group.n,
                "mean rank": group.mean_rank,
                "mean": group.mean,
                "sd": group.sd,
                "median": group.median,
                "first quartile": group.quartiles[0],
                "third quartile": group.quartiles[1],
                "Shapiro-Wilk p": group.shapiro_p,
                "letters": "" if each.comparison is None else each.comparison.letters[group.name],
            }
            for each in found
            for group in each.groups
        ]
    )
    return in_unit(table, ["mean", "sd", "median", "first quartile", "third quartile"], unit)


def summary_article(found: Sequence[Compared], unit: str = "") -> pd.DataFrame:
    """Return the summary for an article: medians, quartiles and letters."""
    factor = unit_factor(unit)
    groups = [group for each in found for group in each.groups]
    places = decimals(
        factor * (group.quartiles[1] - group.quartiles[0]) / math.sqrt(group.n) for group in groups
    )
    return pd.DataFrame(
        [
            {
                "heading": each.heading,
                "group": group.name,
                "runs": group.n,
                axis_title("median", unit): fixed(factor * group.median, places),
                axis_title("quartiles", unit): quartiles_cell(
                    factor * group.quartiles[0], factor * group.quartiles[1], places
                ),
                "letters": "" if each.comparison is None else each.comparison.letters[group.name],
            }
            for each in found
            for group in each.groups
        ]
    )


def pairs_article(found: Sequence[Compared]) -> pd.DataFrame:
    """Return the table of pairs for an article."""
    lines = [
        {
            "heading": each.heading,
            "first": pair.first,
            "second": pair.second,
            "Dunn p": p_cell(pair.p if each.comparison.tested else None),
            "A12": f"{pair.a12:.2f}",
        }
        for each in found
        if each.comparison is not None
        for pair in each.comparison.pairs
    ]
    return pd.DataFrame(lines, columns=["heading", "first", "second", "Dunn p", "A12"])


def ranking_article(found: Sequence[Compared]) -> pd.DataFrame:
    """Return the table of rankings for an article."""
    lines = [
        {
            "heading": each.heading,
            "ranking": each.comparison.ranking,
            "H": f"{each.comparison.h:.2f}" if each.comparison.tested else "-",
            "p": p_cell(each.comparison.p if each.comparison.tested else None),
            "epsilon squared": f"{each.comparison.epsilon_squared:.3f}",
        }
        for each in found
        if each.comparison is not None
    ]
    return pd.DataFrame(lines, columns=["heading", "ranking", "H", "p", "epsilon squared"])


def pairs_table(found: Sequence[Compared]) -> pd.DataFrame:
    """Return a line for each pair of groups: Dunn's p and A12; no p for groups of fewer than five runs."""
    lines = [
        {
            **each.where,
            "first": pair.first,
            "second": pair.second,
            "Dunn p": pair.p if each.comparison.tested else None,
            "correction": each.comparison.correction,
            "A12": pair.a12,
        }
        for each in found
        if each.comparison is not None
        for pair in each.comparison.pairs
    ]
    return pd.DataFrame(lines, columns=[*_WHERE, "first", "second", "Dunn p", "correction", "A12"])


def ranking_table(found: Sequence[Compared]) -> pd.DataFrame:
    """Return a line for each view and yardstick: Kruskal-Wallis test and ranking in the paper's notation."""
    lines = [
        {
            **each.where,
            "ranking": each.comparison.ranking,
            "Kruskal-Wallis H": each.comparison.h if each.comparison.tested else None,
            "p": each.comparison.p if each.comparison.tested else None,
            "epsilon squared": each.comparison.epsilon_squared,
        }
        for each in found
        if each.comparison is not None
    ]
    return pd.DataFrame(lines, columns=[*_WHERE, "ranking", "Kruskal-Wallis H", "p", "epsilon squared"])


def verification_table(verification: Verification) -> pd.DataFrame:
    """Return a line for each variant: its median score, and this score as a share of the unchanged one."""
    table = pd.DataFrame(
        [
            {
                "variant": finding.name,
                "median": finding.median,
                "of unchanged": verification.share(finding),
                "draws": len(finding.scores),
                "diverged": len(finding.diverged_at),
            }
            for finding in verification.rows
        ]
    )
    return in_unit(table, ["median"], verification.unit)


def versions_table(provenance: Mapping[str, Any]) -> pd.DataFrame:
    """Return a line for each entry of a run's provenance, such as versions; none without provenance."""
    found = [
        (key, ", ".join(map(str, value)) if isinstance(value, list) else str(value))
        for key, value in (leaves(provenance) if provenance else ())
    ]
    return pd.DataFrame(found, columns=["what", "which"])
