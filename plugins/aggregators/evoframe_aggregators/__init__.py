"""Aggregators: averages of an individual's scores, and credit from all meetings of a turn.

The four averages of the paper are in :mod:`.means` and :mod:`.weighted`. Results do not depend on the order
of scores or meetings, to the last bit: scores are sorted first, and sums are rounded once.
"""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Aggregator, Credit, hookimpl
from evoframe_aggregators.games import Difference, Shapley
from evoframe_aggregators.lenient import Lenient
from evoframe_aggregators.means import ArithmeticMean, GeometricMean, HarmonicMean, PowerMean
from evoframe_aggregators.ordered import Maximum, Median, Minimum, Quantile
from evoframe_aggregators.rank import Rank
from evoframe_aggregators.risk import MeanMinusDeviation
from evoframe_aggregators.weighted import OrderedWeightedAverage, WeightedMean
from evoframe_aggregators.weights import PAPER_WEIGHTS

__all__ = [
    "PAPER_WEIGHTS",
    "ArithmeticMean",
    "Difference",
    "GeometricMean",
    "HarmonicMean",
    "Lenient",
    "Maximum",
    "MeanMinusDeviation",
    "Median",
    "Minimum",
    "OrderedWeightedAverage",
    "PowerMean",
    "Quantile",
    "Rank",
    "Shapley",
    "WeightedMean",
    "evoframe_aggregators",
]


@hookimpl
def evoframe_aggregators() -> Mapping[str, type[Aggregator | Credit]]:
    """Register the averages of the paper, further averages, and credit from all meetings of a turn."""
    return {
        "am": ArithmeticMean,
        "wm": WeightedMean,
        "gm": GeometricMean,
        "hm": HarmonicMean,
        "max": Maximum,
        "min": Minimum,
        "median": Median,
        "quantile": Quantile,
        "power": PowerMean,
        "owa": OrderedWeightedAverage,
        "mean-minus-sd": MeanMinusDeviation,
        "lenient": Lenient,
        "rank": Rank,
        "difference": Difference,
        "shapley": Shapley,
    }
