"""Are groups of runs different, by how much, and how sure is that?

The test of the paper, Dunn's after Shapiro-Wilk (paper.md, "The experiments"), and beside it what belongs to
it: Kruskal-Wallis before, a named correction for many comparisons, and effect sizes.
"""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import attrs
import numpy as np
import scikit_posthocs as posthocs
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.pairs import find_pair, in_notation

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
"""Values of a group, with fewer of which tests, bands and boxes say nothing."""

_JUDGED = 3  # values at least, that Shapiro-Wilk can judge


@attrs.frozen
class Group:
    """The values of one configuration.

    Attributes:
        name: What it is called.
        n: How many values.
        mean: Their arithmetic mean.
        sd: Their standard deviation, of a sample; ``None`` of one value.
        median: Their median.
        quartiles: The first and the third.
        mean_rank: The mean of their ranks among the values of all groups, 1 being the least.
        shapiro_p: Shapiro-Wilk's p: small where they are not normal; ``None`` where that cannot be judged.
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
    """Two groups.

    Attributes:
        first: The name of one.
        second: The name of the other.
        p: Dunn's p, corrected.
        a12: Vargha and Delaney's A: the probability that a value of the first is the greater, ties half.
        direction: 1 if the first has the greater mean rank, which is what Dunn tests, -1 if the second has.
    """

    first: str
    second: str
    p: float
    a12: float
    direction: int

    def turned(self) -> Pairwise:
        """Return the same of the second and the first."""
        return Pairwise(self.second, self.first, self.p, 1 - self.a12, -self.direction)


@attrs.frozen
class Comparison:
    """What can be said of several groups.

    Attributes:
        groups: From the greatest mean rank down.
        correction: Of the p-values of pairs.
        alpha: Below which p two groups count as different.
        h: Kruskal and Wallis' statistic.
        p: Its p.
        epsilon_squared: Its effect size: the share of the variance of ranks that lies between groups.
        pairs: All pairs, in the order of the groups.
        letters: Name -> letters; groups that share one are not different. Without any where the alphabet,
            of 52 letters, does not suffice.
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
    def ranking(self) -> str:
        """The groups from the greatest mean rank down, in the paper's notation: ``WM > HM > AM = GM``.

        Between neighbours stands what is said of these two alone; :attr:`letters` has all pairs.
        """
        return in_notation([group.name for group in self.groups], self.pair, self.alpha)

    def pair(self, first: str, second: str) -> Pairwise:
        """Return what is said of two groups.

        Raises:
            KeyError: One of them is none of the groups.
        """
        return find_pair(self.pairs, first, second)


def compare(
    values: Mapping[str, Sequence[float]], correction: Correction = "holm", alpha: float = 0.05
) -> Comparison:
    """Compare groups of independent values.

    Args:
        values: Name -> values, at least one for each of at least two groups.
        correction: For many comparisons.
        alpha: Below which p two groups count as different.

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
        letters=dict(zip(names, _letters(dunn, alpha), strict=True)),
    )


def ranked(values: Mapping[str, Sequence[float]]) -> tuple[Group, ...]:
    """Return how the values of each group lie, from the greatest mean rank down, those alike by their names.

    Args:
        values: Name -> values, at least one for each group.
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
    """Return the probability that a value of the first group is the greater, ties half.

    Source: Vargha and Delaney 2000, equation 14.
    """
    u = stats.mannwhitneyu(first, second, method="asymptotic").statistic
    return float(u) / (len(first) * len(second))


def detectable_a12(n: int, comparisons: int, alpha: float = 0.05, power: float = 0.8) -> float:
    """Return the smallest A12 above one half that a rank test would find, in most cases, with so few values.

    Args:
        n: Values in each of two groups.
        comparisons: For how many of them *alpha* must do (Bonferroni).
        alpha: The error that is accepted.
        power: In what share of the cases it would be found.

    Source: Noether 1987, equation 3, for two groups of one size.
    """
    quantiles = stats.norm.isf(alpha / comparisons / 2) + stats.norm.isf(1 - power)
    return min(1.0, 0.5 + float(quantiles) / math.sqrt(6 * n))


def _shapiro(array: Floats) -> float | None:
    if len(array) < _JUDGED or np.ptp(array) == 0:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that p of many values is not exact
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
    """Return the letters of each group: groups that share one are not different."""
    try:
        letters = posthocs.compact_letter_display(p, alpha)
    except ValueError as error:
        if "letter" not in str(error):
            raise
        return [""] * len(p)  # it needs more letters than there are
    return [str(letter).replace(" ", "") for letter in letters]
