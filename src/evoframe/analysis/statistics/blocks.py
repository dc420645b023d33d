"""Groups that were measured under the same circumstances, one after the other: blocks.

Bodies under the same sets of phase offsets are such groups: what a set is worth is the same for all bodies,
and comparing within sets takes it out.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray
from scipy import stats
from statsmodels.stats.multitest import multipletests

from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.pairs import find_pair, in_notation

__all__ = ["BlockComparison", "BlockPair", "compare_blocks"]

Floats: TypeAlias = NDArray[np.float64]


@attrs.frozen
class BlockPair:
    """Two groups, compared within blocks.

    Attributes:
        first: The name of one.
        second: The name of the other.
        p: Wilcoxon's p of the differences, corrected.
        wins: The share of blocks in which the first is the greater, ties half.
        direction: 1 if the ranks of the differences, which Wilcoxon tests, are for the first, -1 if for the
            second, 0 if they are even.
    """

    first: str
    second: str
    p: float
    wins: float
    direction: int

    def turned(self) -> BlockPair:
        """Return the same of the second and the first."""
        return BlockPair(self.second, self.first, self.p, 1 - self.wins, -self.direction)


@attrs.frozen
class BlockComparison:
    """What can be said of several groups of the same blocks.

    Attributes:
        names: From the greatest mean rank down.
        mean_ranks: Name -> the mean of its ranks within blocks, 1 being the least.
        blocks: How many there are.
        correction: Of the p-values of pairs.
        chi_squared: Friedman's statistic; ``None`` for two groups, which Wilcoxon compares.
        p: Its p, or Wilcoxon's.
        kendall_w: Its effect size: 1 if all blocks rank the groups alike, 0 if there is nothing in common.
        pairs: All pairs, in the order of the names.
    """

    names: tuple[str, ...]
    mean_ranks: Mapping[str, float]
    blocks: int
    correction: Correction
    chi_squared: float | None
    p: float
    kendall_w: float | None
    pairs: tuple[BlockPair, ...]

    def ranking(self, alpha: float = 0.05) -> str:
        """Return the groups from the greatest mean rank down, in the paper's notation: ``NEAT > AFPO``.

        Args:
            alpha: Below which p two neighbours count as different.
        """
        return in_notation(self.names, self.pair, alpha)

    def pair(self, first: str, second: str) -> BlockPair:
        """Return what is said of two groups.

        Raises:
            KeyError: One of them is none of the groups.
        """
        return find_pair(self.pairs, first, second)


def compare_blocks(values: Mapping[str, Sequence[float]], correction: Correction = "holm") -> BlockComparison:
    """Compare groups whose values belong together, the first of each with the first of the others, and so on.

    Args:
        values: Name -> values, as many for each of at least two groups.
        correction: Of the p-values of pairs.

    Raises:
        ValueError: There are too few groups or values, not as many for each, or a value is not finite.

    Sources: Friedman 1937; Wilcoxon 1945, where zeros are ranked and then dropped (Pratt 1959), exact for at
    most 50 blocks without ties; Kendall and Smith 1939.
    """
    lengths = {len(given) for given in values.values()}
    if len(values) < 2 or len(lengths) != 1 or lengths == {0}:
        raise ValueError(f"expected as many values for each of 2 or more groups, found {sorted(lengths)}")
    table = np.array(list(values.values()), dtype=np.float64).T
    if not np.isfinite(table).all():
        raise ValueError("expected finite numbers")
    ranks = stats.rankdata(table, axis=1).mean(axis=0)
    order = sorted(range(table.shape[1]), key=lambda i: (-ranks[i], list(values)[i]))
    names = [list(values)[i] for i in order]
    ordered = table[:, order]
    pairs = list(itertools.combinations(range(len(names)), 2))
    raw = [_wilcoxon(ordered[:, i], ordered[:, j]) for i, j in pairs]
    corrected = raw if correction == "none" else multipletests(raw, method=correction)[1].tolist()
    chi_squared, p = _friedman(ordered) if len(names) > 2 else (None, raw[0])
    return BlockComparison(
        names=tuple(names),
        mean_ranks={name: float(ranks[i]) for name, i in zip(names, order, strict=True)},
        blocks=len(table),
        correction=correction,
        chi_squared=chi_squared,
        p=p,
        kendall_w=None if chi_squared is None else chi_squared / (len(table) * (len(names) - 1)),
        pairs=tuple(
            _pair(names[i], names[j], p_of_pair, ordered[:, i] - ordered[:, j])
            for (i, j), p_of_pair in zip(pairs, corrected, strict=True)
        ),
    )


def _friedman(table: Floats) -> tuple[float, float]:
    if (table == table[:, :1]).all():
        return 0.0, 1.0  # all ranks are tied
    found = stats.friedmanchisquare(*table.T)
    return float(found.statistic), float(found.pvalue)


def _wilcoxon(first: Floats, second: Floats) -> float:
    if (first == second).all():
        return 1.0
    return float(stats.wilcoxon(first, second, zero_method="pratt", method="auto").pvalue)


def _pair(first: str, second: str, p: float, differences: Floats) -> BlockPair:
    signs = np.sign(differences)
    ranked = float(np.sum(signs * stats.rankdata(np.abs(differences))))
    return BlockPair(first, second, p, wins=float(np.mean(0.5 + 0.5 * signs)), direction=int(np.sign(ranked)))
