"""What time and room the missing runs of a study take: from those that are there, or from a trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import attrs

from evoframe.evolution import assemble
from evoframe.study.plan import Planned

__all__ = ["Estimate", "estimate_cost"]

_BYTES = 200_000, 40  # of a run's directory: its state, and each pair with its share of the individuals


@attrs.frozen
class Estimate:
    """What the missing runs will take.

    Attributes:
        seconds: Of one core after the other.
        megabytes: On the disk.
        measured: What that was concluded from.
    """

    seconds: float
    megabytes: float
    measured: str


def estimate_cost(missing: Sequence[Planned], finished: Mapping[Planned, float]) -> Estimate:
    """Return what the missing runs will take: at most that, where it is concluded from a trial.

    The costs of a run go with its pairs, although those that were simulated before cost little.

    Args:
        missing: The runs.
        finished: Runs that are there, and how many seconds each has taken.
    """
    pairs = sum(run.cell.pairs for run in missing)
    if finished:
        share = pairs / sum(run.cell.pairs for run in finished)
        size = sum(path.stat().st_size for run in finished for path in run.directory.iterdir())
        measured = f"{len(finished)} finished runs"
        return Estimate(sum(finished.values()) * share, size * share / 1e6, measured)
    seconds_per_pair = 0.0
    if missing:
        with assemble(missing[0].cell.config) as coevolution:
            work = next(iter(coevolution)).workload  # the initial meeting: few pairs are repeats
            seconds_per_pair = work.seconds / work.pairs * coevolution.evaluator.workers.workers
    size = len(missing) * _BYTES[0] + pairs * _BYTES[1]
    return Estimate(seconds_per_pair * pairs, size / 1e6, "the first turn of one run")
