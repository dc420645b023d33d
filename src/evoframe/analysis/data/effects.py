"""Main effects and interaction of the two keys of a study's grid."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import pandas as pd

from evoframe.analysis.data.studies import YARDSTICKS, StudyData, Yardstick
from evoframe.analysis.data.units import NAMES
from evoframe.analysis.output.latex import p_cell
from evoframe.analysis.statistics.factorial import Effect, factorial_effects
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.study import Row, headings

__all__ = ["Factorial", "effects_article", "effects_table", "factorials"]


@attrs.frozen
class Factorial:
    """Effects of the two keys of a grid on one measure.

    Attributes:
        yardstick: The measure.
        effects: Both main effects and the interaction.
    """

    yardstick: Yardstick
    effects: tuple[Effect, ...]

    @property
    def measure(self) -> str:
        """The name of the measure."""
        return NAMES[self.yardstick]


def factorials(data: StudyData) -> list[Factorial]:
    """Return the effects of the keys of a two-way grid on each measure.

    Returns:
        One item per measure; none unless the grid has two keys with at least two values each, and every
        combination has at least five finished runs, the smallest group for which tests are shown.
    """
    if len(data.keys) != 2:
        return []
    first, second = data.keys
    cells: dict[tuple[str, str], list[Row]] = {}
    for row in data.rows:
        cells.setdefault((row.settings[first], row.settings[second]), []).append(row)
    levels = [{cell[place] for cell in cells} for place in (0, 1)]
    complete = len(cells) == len(levels[0]) * len(levels[1]) and min(map(len, levels)) > 1
    if not complete or min(map(len, cells.values())) < FEWEST:
        return []
    one, other = headings(data.keys).values()
    found = []
    for yardstick in YARDSTICKS:
        values = {cell: [getattr(row, yardstick) for row in rows] for cell, rows in cells.items()}
        found.append(Factorial(yardstick, tuple(factorial_effects(values, (one, other)))))
    return found


def effects_table(found: Sequence[Factorial]) -> pd.DataFrame:
    """Return a line for each effect on each measure."""
    return pd.DataFrame(
        [
            {
                "yardstick": each.yardstick,
                "effect": " x ".join(effect.factors),
                "F": effect.f,
                "df": effect.df,
                "df residual": effect.df_residual,
                "p": effect.p,
                "partial eta squared": effect.partial_eta_squared,
            }
            for each in found
            for effect in each.effects
        ]
    )


def effects_article(found: Sequence[Factorial]) -> pd.DataFrame:
    """Return the effects for an article."""
    return pd.DataFrame(
        [
            {
                "heading": each.measure,
                "effect": " x ".join(effect.factors),
                "F": f"F({effect.df}, {effect.df_residual}) = {effect.f:.2f}",
                "p": p_cell(effect.p),
                "partial eta squared": f"{effect.partial_eta_squared:.3f}",
            }
            for each in found
            for effect in each.effects
        ]
    )
