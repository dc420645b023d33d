"""A complete third-party plugin with one component."""

import statistics

import attrs

from evoframe import hookimpl


@attrs.frozen
class Median:
    """Median of the scores."""

    domain = (-1e100, 1e100)

    def check(self, n):
        pass

    def aggregate(self, scores):
        return float(statistics.median(scores.tolist()))


@hookimpl
def evoframe_aggregators():
    return {"middle": Median}
