"""Comparison of groups that were measured under the same conditions (blocks).

Example: all bodies are simulated with the same controllers. Comparing bodies within each controller removes
the differences between controllers.
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
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.analysis.statistics.pairs import find_pair, format_ranking

__all__ = ["BlockComparison", "BlockPair", "compare_blocks"]

Floats: TypeAlias = NDArray[np.float64]


@attrs.frozen
class BlockPair:
    """Two groups, compared within blocks.

    Attributes:
        first: Name of the first group.
        second: Name of the second group.
        p: Corrected p-value of Wilcoxon's signed-rank test of the differences.
        wins: Share of blocks in which the first group is greater; ties count half.
        direction: 1 if the ranks of the differences, which Wilcoxon tests, favor the first group, -1 if the
            second, 0 if neither.
    """

    first: str
    second: str
    p: float
    wins: float
    direction: int

    def turned(self) -> BlockPair:
        """Return the comparison with the two groups swapped."""
        return BlockPair(self.second, self.first, self.p, 1 - self.wins, -self.direction)


@attrs.frozen
class BlockComparison:
    """Comparison of several groups within blocks.

    Attributes:
        names: Names of the groups, from the greatest mean rank to the smallest.
        mean_ranks: Name -> mean of the ranks within blocks; 1 is the smallest value.
        blocks: Number of blocks.
        correction: Correction of the pairwise p-values for multiple comparisons.
        chi_squared: Statistic of the Friedman test; ``None`` for two groups, which Wilcoxon's test compares.
        p: p-value of the Friedman test, or of Wilcoxon's test for two groups.
        kendall_w: Kendall's W, the effect size: 1 if all blocks rank the groups in the same order, 0 if their
            ranks have nothing in common; ``None`` for two groups.
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

    @property
    def tested(self) -> bool:
        """True if there are at least five blocks; with fewer, reports give no p-values."""
        return self.blocks >= FEWEST

    def ranking(self, alpha: float = 0.05) -> str:
        """Return the groups by decreasing mean rank, in the paper's notation: ``NEAT > AFPO``.

        With too few blocks for tests, commas replace the signs.

        Args:
            alpha: Significance level.
        """
        if not self.tested:
            return ", ".join(self.names)
        return format_ranking(self.names, self.pair, alpha)

    def pair(self, first: str, second: str) -> BlockPair:
        """Return the comparison of two groups.

        Raises:
            KeyError: One of the names is not a group.
        """
        return find_pair(self.pairs, first, second)


def compare_blocks(values: Mapping[str, Sequence[float]], correction: Correction = "holm") -> BlockComparison:
    """Compare groups within blocks; the i-th values of all groups are one block.

    Args:
        values: Name -> values; at least two groups of the same number of values.
        correction: Correction of the pairwise p-values for multiple comparisons.

    Raises:
        ValueError: There are too few groups or values, their numbers differ, or a value is not finite.

    Sources: Friedman 1937; Wilcoxon 1945, where zeros are ranked and then dropped (Pratt 1959), exact for at
    most 50 blocks without ties; Kendall and Smith 1939.
    """
    lengths = {len(given) for given in values.values()}
    if len(values) < 2 or len(lengths) != 1 or lengths == {0}:
        raise ValueError(
            f"expected 2 or more groups of equal length, found {len(values)} of {sorted(lengths)}"
        )
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
