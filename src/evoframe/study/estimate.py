"""Estimates of time and disk space for the missing runs of a study, from finished runs or a trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import attrs

from evoframe.evolution import assemble
from evoframe.study.plan import Planned

__all__ = ["Estimate", "estimate_cost"]

_RUN_BYTES = 120_000  # a run's directory without the rows of its pairs and individuals
_PAIR_BYTES = 40  # a pair's row
_INDIVIDUAL_BYTES = 90  # an individual's row in one turn


@attrs.frozen
class Estimate:
    """Time and disk space of the missing runs.

    Attributes:
        seconds: Sum of the core time of all missing runs, s.
        megabytes: Disk space, MB.
        measured: The source of the figures, such as ``3 finished runs``.
        bound: ``at most`` if the figures are upper bounds, ``about`` if they are extrapolated from finished
            runs.
    """

    seconds: float
    megabytes: float
    measured: str
    bound: Literal["at most", "about"] = "at most"


def estimate_cost(missing: Sequence[Planned], finished: Mapping[Planned, float]) -> Estimate:
    """Estimate the time and disk space of the missing runs.

    The estimates are proportional to the number of pairs. If runs are finished, their measured cost per pair
    is used. Otherwise a trial of the initial turn gives an upper bound on the time, since it has few repeated
    pairs, which cost little.

    Args:
        missing: The runs to estimate.
        finished: The finished runs, with the seconds that each has taken.
    """
    pairs = sum(run.cell.pairs for run in missing)
    if finished:
        share = pairs / sum(run.cell.pairs for run in finished)
        size = sum(path.stat().st_size for run in finished for path in run.directory.iterdir())
        measured = "1 finished run" if len(finished) == 1 else f"{len(finished)} finished runs"
        return Estimate(sum(finished.values()) * share, size * share / 1e6, measured, "about")
    seconds_per_pair = 0.0
    if missing:
        with assemble(missing[0].cell.config) as coevolution:
            work = next(iter(coevolution)).workload  # the initial turn, with few repeated pairs
            seconds_per_pair = work.seconds / work.pairs * coevolution.evaluator.workers.workers
    individuals = sum(run.cell.individuals for run in missing)
    size = len(missing) * _RUN_BYTES + pairs * _PAIR_BYTES + individuals * _INDIVIDUAL_BYTES
    return Estimate(seconds_per_pair * pairs, size / 1e6, "the first turn of one run")
