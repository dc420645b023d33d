"""Main effects and interaction of two factors by the aligned rank transform.

Source: Wobbrock, Findlater, Gergle and Higgins, *The Aligned Rank Transform for Nonparametric Factorial
Analyses Using Only ANOVA Procedures*, CHI 2011. For each effect, the values are stripped of the other effects
("aligned") and ranked; an analysis of variance of the ranks, of which only this effect is read, tests it
without assuming normally distributed values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import attrs
import pandas as pd
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm

__all__ = ["Effect", "factorial_effects"]

_TERMS = {
    "C(first, Sum)": ("first",),
    "C(second, Sum)": ("second",),
    "C(first, Sum):C(second, Sum)": ("first", "second"),
}


@attrs.frozen
class Effect:
    """Test of one effect.

    Attributes:
        factors: The factor of a main effect, or both factors of the interaction.
        f: F statistic of the aligned ranks.
        df: Degrees of freedom of the effect.
        df_residual: Degrees of freedom of the residuals.
        p: p-value.
        partial_eta_squared: Effect size: share of the variance of the aligned ranks that is not due to other
            effects.
    """

    factors: tuple[str, ...]
    f: float
    df: int
    df_residual: int
    p: float
    partial_eta_squared: float


def factorial_effects(
    values: Mapping[tuple[str, str], Sequence[float]], names: tuple[str, str]
) -> list[Effect]:
    """Return the tests of both main effects and of the interaction.

    Args:
        values: Levels of both factors -> values of that cell; every combination of at least two levels each,
            with at least two values.
        names: Names of the factors.

    Raises:
        ValueError: A combination is missing, or has fewer than two values.
    """
    levels = [dict.fromkeys(key[place] for key in values) for place in (0, 1)]
    if min(map(len, levels)) < 2 or len(values) != len(levels[0]) * len(levels[1]):
        raise ValueError("expected every combination of at least two levels of two factors")
    if min(map(len, values.values())) < 2:
        raise ValueError("expected at least two values in every combination")
    frame = pd.DataFrame(
        [(first, second, value) for (first, second), cell in values.items() for value in cell],
        columns=["first", "second", "value"],
    )
    called = dict(zip(("first", "second"), names, strict=True))
    return [_effect(frame, term, tuple(called[each] for each in of)) for term, of in _TERMS.items()]


def _effect(frame: pd.DataFrame, term: str, factors: tuple[str, ...]) -> Effect:
    ranked = frame.assign(rank=stats.rankdata(_aligned(frame, _TERMS[term]).round(15)))
    table = anova_lm(ols("rank ~ C(first, Sum) * C(second, Sum)", ranked).fit(), typ=3)
    own, residual = table.loc[term], table.loc["Residual"]
    return Effect(
        factors,
        float(own["F"]),
        int(own["df"]),
        int(residual["df"]),
        float(own["PR(>F)"]),
        float(own["sum_sq"] / (own["sum_sq"] + residual["sum_sq"])),
    )


def _aligned(frame: pd.DataFrame, of: tuple[str, ...]) -> pd.Series:
    """Return the values without all effects but the one of the factors *of*."""
    means = {
        key: frame.groupby(list(key))["value"].transform("mean")
        for key in (("first",), ("second",), ("first", "second"))
    }
    residual, grand = frame["value"] - means["first", "second"], frame["value"].mean()
    if len(of) == 1:
        return residual + means[of] - grand
    return residual + means["first", "second"] - means[("first",)] - means[("second",)] + grand
