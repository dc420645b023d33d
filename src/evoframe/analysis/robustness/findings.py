"""Comparisons of the groups of a measurement: across controllers, within controllers, and by body."""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe.analysis.statistics.blocks import BlockComparison, compare_blocks
from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.groups import Comparison, compare
from evoframe.robustness import Robustness

__all__ = ["Findings", "find"]


@attrs.frozen(eq=False)
class Findings:
    """A measurement and its tests, which are ``None`` if nothing can be compared.

    All tests use the controllers with which no body diverged. With each of them, the score of a group is the
    median of its bodies' scores.

    Attributes:
        measured: The measurement.
        apart: Controllers as independent samples, as in the paper: Kruskal-Wallis and Dunn's test.
        within: Groups compared within each controller: Friedman and Wilcoxon's tests.
        by_body: Medians of bodies, one value per body; ``None`` unless a group has several bodies.
    """

    measured: Robustness
    apart: Comparison | None
    within: BlockComparison | None
    by_body: Comparison | None

    @property
    def common(self) -> int:
        """Number of controllers with which no body diverged."""
        return len(self.measured.common)


def find(measured: Robustness, correction: Correction = "holm") -> Findings:
    """Compare the groups of a measurement.

    Args:
        measured: The measurement.
        correction: Correction of pairwise p-values for multiple comparisons; the paper uses ``none``.
    """
    groups = measured.setting.groups
    if len(groups) < 2 or not len(measured.common):
        return Findings(measured, None, None, None)
    values = _listed({name: _middle(measured, columns, axis=1) for name, columns in groups.items()})
    medians = _listed({name: _middle(measured, columns, axis=0) for name, columns in groups.items()})
    several = len(measured.setting.bodies) > len(groups)
    return Findings(
        measured,
        apart=compare(values, correction),
        within=compare_blocks(values, correction),
        by_body=compare(medians, correction) if several else None,
    )


def _middle(measured: Robustness, columns: list[int], axis: int) -> NDArray[np.float64]:
    """Return the median over bodies (axis 1) or over controllers (axis 0)."""
    middle: NDArray[np.float64] = np.median(measured.scores[measured.common][:, columns], axis=axis)
    return middle


def _listed(values: Mapping[str, NDArray[np.float64]]) -> dict[str, list[float]]:
    return {name: array.tolist() for name, array in values.items()}
