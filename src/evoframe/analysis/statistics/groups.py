"""Comparison of independent groups of values: tests, effect sizes and rankings.

The paper uses Shapiro-Wilk and Dunn's test (docs/experiment.md, "The experiments"). Added here are the
Kruskal-Wallis test of all groups, a named correction for multiple comparisons, and effect sizes.
"""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib

# isort: split
import attrs
import numpy as np
import scikit_posthocs as posthocs
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.pairs import find_pair, format_ranking

__all__ = [
    "FEWEST",
    "Comparison",
    "Group",
    "Pairwise",
    "a12",
    "compare",
    "detectable_a12",
    "ranked",
]

Floats: TypeAlias = NDArray[np.float64]

FEWEST = 5
"""Smallest group for which tests, bands and box plots are shown."""

_JUDGED = 3  # values that Shapiro-Wilk requires at least


@attrs.frozen
class Group:
    """The values of one configuration.

    Attributes:
        name: Name of the group.
        n: Number of values.
        mean: Arithmetic mean.
        sd: Sample standard deviation; ``None`` for a single value.
        median: Median.
        quartiles: First and third quartile.
        mean_rank: Mean of the ranks among the values of all groups; 1 is the smallest value.
        shapiro_p: p-value of Shapiro-Wilk, small for values that are not normally distributed; ``None`` for
            fewer than three values or equal ones.
    """

    name: str
    n: int
    mean: float
    sd: float | None
    median: float
    quartiles: tuple[float, float]
    mean_rank: float
    shapiro_p: float | None


@attrs.frozen
class Pairwise:
    """Comparison of two groups.

    Attributes:
        first: Name of the first group.
        second: Name of the second group.
        p: Corrected p-value of Dunn's test.
        a12: Vargha and Delaney's A: the probability that a value of the first group exceeds one of the
            second; ties count half.
        direction: 1 if the first group has the greater mean rank, which Dunn's test compares; -1 if the
            second has.
    """

    first: str
    second: str
    p: float
    a12: float
    direction: int

    def turned(self) -> Pairwise:
        """Return the comparison with the two groups swapped."""
        return Pairwise(self.second, self.first, self.p, 1 - self.a12, -self.direction)


@attrs.frozen
class Comparison:
    """Comparison of several groups.

    Attributes:
        groups: The groups, sorted from the greatest mean rank to the smallest.
        correction: Correction of the pairwise p-values for multiple comparisons.
        alpha: Significance level.
        h: Statistic of the Kruskal-Wallis test.
        p: p-value of the Kruskal-Wallis test.
        epsilon_squared: Effect size: the share of the variance of ranks that lies between groups.
        pairs: All pairs, in the order of the groups.
        letters: Name -> letters; groups that share a letter do not differ significantly. Empty strings if
            groups are too small for tests, or 52 letters are too few.
    """

    groups: tuple[Group, ...]
    correction: Correction
    alpha: float
    h: float
    p: float
    epsilon_squared: float
    pairs: tuple[Pairwise, ...]
    letters: Mapping[str, str]

    @property
    def tested(self) -> bool:
        """True if the smallest group has at least five values; with fewer, reports give no p-values."""
        return min(group.n for group in self.groups) >= FEWEST

    @property
    def ranking(self) -> str:
        """The groups by decreasing mean rank, in the paper's notation: ``WM > HM > AM = GM``.

        Each sign compares only its two neighbors; :attr:`letters` cover all pairs. If groups are too small
        for tests, commas replace the signs.
        """
        if not self.tested:
            return ", ".join(group.name for group in self.groups)
        return format_ranking([group.name for group in self.groups], self.pair, self.alpha)

    def pair(self, first: str, second: str) -> Pairwise:
        """Return the comparison of two groups.

        Raises:
            KeyError: One of the names is not a group.
        """
        return find_pair(self.pairs, first, second)


def compare(
    values: Mapping[str, Sequence[float]], correction: Correction = "holm", alpha: float = 0.05
) -> Comparison:
    """Compare groups of independent values.

    Args:
        values: Name -> values; at least two groups of at least one value.
        correction: Correction of the pairwise p-values for multiple comparisons.
        alpha: Significance level.

    Raises:
        ValueError: There are too few groups or values, or a value is not finite.

    Sources: Kruskal and Wallis 1952; Dunn 1964; Vargha and Delaney 2000; epsilon squared after Tomczak and
    Tomczak 2014; letters after Piepho 2004.
    """
    arrays = {name: np.asarray(given, dtype=np.float64) for name, given in values.items()}
    if len(arrays) < 2:
        raise ValueError(f"a comparison needs at least 2 groups, found {len(arrays)}")
    for name, array in arrays.items():
        if array.ndim != 1 or len(array) == 0 or not np.isfinite(array).all():
            raise ValueError(f"{name}: expected one or more finite numbers")
    groups = ranked(values)
    ranks = {group.name: group.mean_rank for group in groups}
    ordered = {name: arrays[name] for name in ranks}
    h, p = _kruskal(list(ordered.values()))
    n = sum(len(array) for array in ordered.values())
    tested = min(len(array) for array in ordered.values()) >= FEWEST
    dunn = _dunn(list(ordered.values()), correction)
    names = list(ordered)
    pairs = [
        Pairwise(
            names[i],
            names[j],
            float(dunn[i, j]),
            a12(ordered[names[i]], ordered[names[j]]),
            direction=int(ranks[names[i]] > ranks[names[j]]),
        )
        for i, j in itertools.combinations(range(len(names)), 2)
    ]
    return Comparison(
        groups=groups,
        correction=correction,
        alpha=alpha,
        h=h,
        p=p,
        epsilon_squared=h / (n - 1),
        pairs=tuple(pairs),
        letters=dict(zip(names, _letters(dunn, alpha) if tested else [""] * len(names), strict=True)),
    )


def ranked(values: Mapping[str, Sequence[float]]) -> tuple[Group, ...]:
    """Return the descriptive statistics of each group by decreasing mean rank; ties are sorted by name.

    Args:
        values: Name -> values, at least one per group.
    """
    arrays = {name: np.asarray(given, dtype=np.float64) for name, given in values.items()}
    ends = np.cumsum([len(array) for array in arrays.values()])
    ranks = np.split(stats.rankdata(np.concatenate([*arrays.values()])), ends[:-1])
    groups = []
    for (name, array), ranks_of_group in zip(arrays.items(), ranks, strict=True):
        low, middle, high = map(float, np.quantile(array, [0.25, 0.5, 0.75]))
        group = Group(
            name=name,
            n=len(array),
            mean=math.fsum(array) / len(array),
            sd=float(np.std(array, ddof=1)) if len(array) > 1 else None,
            median=middle,
            quartiles=(low, high),
            mean_rank=float(ranks_of_group.mean()),
            shapiro_p=_shapiro(array),
        )
        groups.append(group)
    return tuple(sorted(groups, key=lambda group: (-group.mean_rank, group.name)))


def a12(first: Sequence[float] | Floats, second: Sequence[float] | Floats) -> float:
    """Return the probability that a value of the first group exceeds one of the second; ties count half.

    Source: Vargha and Delaney 2000, equation 14.
    """
    u = stats.mannwhitneyu(first, second, method="asymptotic").statistic
    return float(u) / (len(first) * len(second))


def detectable_a12(n: int, comparisons: int, alpha: float = 0.05, power: float = 0.8) -> float:
    """Return the smallest A12 above 0.5 that a rank test detects with the given power.

    Args:
        n: Values in each of two groups.
        comparisons: Number of comparisons that share *alpha* (Bonferroni).
        alpha: Significance level of all comparisons together.
        power: Probability to detect the effect.

    Source: Noether 1987, equation 3, for two groups of the same size.
    """
    quantiles = stats.norm.isf(alpha / comparisons / 2) + stats.norm.isf(1 - power)
    return min(1.0, 0.5 + float(quantiles) / math.sqrt(6 * n))


def _shapiro(array: Floats) -> float | None:
    if len(array) < _JUDGED or np.ptp(array) == 0:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the p-value of many values is not exact
        return float(stats.shapiro(array).pvalue)


def _kruskal(arrays: Sequence[Floats]) -> tuple[float, float]:
    if np.ptp(np.concatenate(arrays)) == 0:
        return 0.0, 1.0  # all ranks are tied
    found = stats.kruskal(*arrays)
    return float(found.statistic), float(found.pvalue)


def _dunn(arrays: Sequence[Floats], correction: Correction) -> Floats:
    """Return the p-values of all pairs, in the order of the groups."""
    if np.ptp(np.concatenate(arrays)) == 0:
        return np.ones((len(arrays), len(arrays)))
    adjusted = None if correction == "none" else correction
    table = posthocs.posthoc_dunn([array.tolist() for array in arrays], p_adjust=adjusted)
    matrix: Floats = table.to_numpy(dtype=np.float64)
    return matrix


def _letters(p: Floats, alpha: float) -> list[str]:
    """Return the letters of each group; groups that share a letter do not differ significantly."""
    try:
        letters = posthocs.compact_letter_display(p, alpha)
    except ValueError as error:
        if "letter" not in str(error):
            raise
        return [""] * len(p)  # more letters are required than exist
    return [str(letter).replace(" ", "") for letter in letters]
