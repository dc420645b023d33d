"""What time and room the missing runs of a study take: from those that are there, or from a trial."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import attrs

from evoframe.evolution.assembly import assemble
from evoframe.record.run import open_run
from evoframe.study.plan import Planned

__all__ = ["Estimate", "estimated"]

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


def estimated(missing: Sequence[Planned], finished: Sequence[Planned]) -> Estimate:
    """Return what the missing runs will take: at most that, where it is concluded from a trial.

    The costs of a run go with its pairs, although those that were simulated before cost little.
    """
    pairs = sum(run.cell.pairs for run in missing)
    if finished:
        done = sum(run.cell.pairs for run in finished)
        seconds, size = _seconds(finished), sum(_size(run) for run in finished)
        return Estimate(seconds / done * pairs, size / done * pairs / 1e6, f"{len(finished)} finished runs")
    size = len(missing) * _BYTES[0] + pairs * _BYTES[1]
    return Estimate(_trial(missing[0]) * pairs if missing else 0.0, size / 1e6, "the first turn of one run")


def _seconds(runs: Iterable[Planned]) -> float:
    total = 0.0
    for planned in runs:
        with open_run(planned.directory) as run:
            total += sum(row["seconds"] for row in run.workload())
    return total


def _size(run: Planned) -> int:
    return sum(path.stat().st_size for path in run.directory.iterdir())


def _trial(run: Planned) -> float:
    """Return what a pair takes in the initial meeting, where few are repeats."""
    with assemble(run.cell.config) as coevolution:
        work = next(iter(coevolution)).workload
        return work.seconds / work.pairs * coevolution.evaluator.workers.workers
