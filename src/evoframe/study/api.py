"""Studies from Python: execute the missing runs, or estimate their time and disk space."""

from __future__ import annotations

import contextlib
import heapq
import logging
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import layers_of
from evoframe.registry import Plugins, discover
from evoframe.study.conduct import Watcher, claim, execute, lock_tables, refuse_another, survey
from evoframe.study.estimate import Estimate, estimate_cost
from evoframe.study.gathered import gather, import_rows, imported_rows, mixed_generations
from evoframe.study.plan import Planned, Study, read_study
from evoframe.study.pool import Pool
from evoframe.study.progress import Status
from evoframe.study.rows import ROWS_FILE, Row, write_rows
from evoframe.study.worker import Order
from evoframe.workers import available_cores

__all__ = ["StudyPlan", "StudyResult", "plan_study", "run_study"]

_log = logging.getLogger(__name__)


@attrs.frozen
class StudyResult:
    """The state of a study, and the rows of its finished runs.

    Attributes:
        study: The study.
        directory: Its directory.
        statuses: Status of each run, in the order of work.
        rows: Row of each finished or imported run, in the order of work.
    """

    study: Study
    directory: Path
    statuses: Mapping[Planned, Status] = attrs.field(repr=False)
    rows: Mapping[Planned, Row] = attrs.field(repr=False)

    @property
    def failed(self) -> dict[Planned, str]:
        """The failed runs, with the cause of each."""
        return {run: status.cause for run, status in self.statuses.items() if status.state == "failed"}

    @property
    def left(self) -> list[Planned]:
        """The runs not yet finished and verified: failed, interrupted, or in progress in another process."""
        return [run for run, status in self.statuses.items() if not status.is_complete]

    @property
    def finished(self) -> dict[Planned, Row]:
        """The rows of the runs finished in this directory, without the imported ones."""
        return {run: row for run, row in self.rows.items() if self.statuses[run].state == "finished"}

    @property
    def unverified(self) -> list[Planned]:
        """The finished runs whose champions are not verified yet."""
        return [run for run in self.finished if not self.statuses[run].verified]

    def unfinished(self, *, retry: bool = False) -> list[Planned]:
        """Return the runs to start or resume; with *retry*, also the failed ones."""
        states = ("missing", "begun", "failed") if retry else ("missing", "begun")
        return [run for run, status in self.statuses.items() if status.state in states]


@attrs.frozen
class StudyPlan:
    """The runs that a study would execute, with their estimated cost.

    Attributes:
        found: The current state of the study.
        to_run: The runs to start or resume.
        cores: Number of cores in use.
        estimate: Core time and disk space of these runs.
    """

    found: StudyResult
    to_run: tuple[Planned, ...]
    cores: int
    estimate: Estimate

    @property
    def seconds(self) -> float:
        """Estimated wall clock of these runs, s; each run occupies one core."""
        pairs = sum(run.cell.pairs for run in self.to_run)
        ends = [0.0] * self.cores
        for run in self.to_run:
            heapq.heapreplace(ends, ends[0] + self.estimate.seconds * run.cell.pairs / pairs)
        return max(ends)


def run_study(  # noqa: PLR0913 - all but the first are keywords
    study: str | Path | Study,
    /,
    *,
    out: str | Path | None = None,
    workers: int = 0,
    retry: bool = False,
    tables: Iterable[str | Path] = (),
    modules: Iterable[str] = (),
    plugins: Plugins | None = None,
    watcher: Watcher | None = None,
    stop: Callable[[], bool] = lambda: False,
    **settings: Any,
) -> StudyResult:
    """Execute the missing runs of a study, as the command ``evoframe study`` does.

    Interrupted runs are resumed, and unverified champions are verified; finished runs stay unchanged. Each
    run has a process of its own, so a script must call this function under ``if __name__ == "__main__":``.

    Args:
        study: Name of a built-in study, path of a TOML file, or a study from :func:`read_study`.
        out: The study's directory; by default ``studies/<label>``.
        workers: Number of parallel runs; 0: one per core.
        retry: Repeat failed runs.
        tables: Paths of ``rows.csv`` of other sessions, whose rows count as finished runs.
        modules: Local plugins (importable names or ``.py`` files) for this process and the workers.
        plugins: The plugins for reading the study; by default the installed ones and *modules*.
        watcher: Receives the progress.
        stop: Called several times a second; if it returns true, runs stop after the turn in progress.
        **settings: Settings by key, as for :func:`evoframe.run`, including ``runs`` and ``grid``; ``grid``
            replaces the whole grid, a dotted key such as ``grid.aggregator`` one key of it.

    Returns:
        The state of the study. It includes the failed runs; a failure does not stop the other runs.

    Raises:
        ConfigurationError: The study is not valid; nothing was run or written.
        InputError: The directory is not that of this study, or a run or table in it is damaged.
        RunError: A file of the study cannot be written.
        KeyboardInterrupt: The runs were interrupted at once; saved turns and the rows of finished runs are
            kept. Not raised if *stop* is true anyway.
    """
    modules, paths, watcher = tuple(modules), [Path(path) for path in tables], watcher or Watcher()
    study, directory = _open(study, out, modules, plugins, settings)
    claim(study, directory)
    with lock_tables(directory) if paths else contextlib.nullcontext():
        imported = (import_rows if paths else imported_rows)(study, directory, paths)
    statuses = survey(study, directory, imported, rows=True)
    found = StudyResult(study, directory, statuses, gather(statuses, imported))
    to_run = found.unfinished(retry=retry)
    todo = [*found.unverified, *to_run]
    _warn_of_generations(found, to_run)
    watcher.on_begin(study, todo, {run: row for run, row in found.rows.items() if statuses[run].is_complete})
    orders = {run: Order(run.directory, study.layers_of(run), study.label, modules) for run in todo}
    try:
        with contextlib.closing(Pool(workers or available_cores(), modules)) as pool:
            execute(orders, pool, watcher, stop)
    except KeyboardInterrupt:
        if not stop():
            raise
    finally:
        settled = {run: statuses[run] for run in found.finished if statuses[run].is_complete}
        with lock_tables(directory):  # so that the last process to write includes the runs of all others
            statuses = survey(study, directory, imported, rows=True, known=settled)
            rows = gather(statuses, imported)
            write_rows(list(rows.values()), directory / ROWS_FILE)
    return StudyResult(study, directory, statuses, rows)


def plan_study(  # noqa: PLR0913 - as run_study
    study: str | Path | Study,
    /,
    *,
    out: str | Path | None = None,
    workers: int = 0,
    retry: bool = False,
    tables: Iterable[str | Path] = (),
    modules: Iterable[str] = (),
    plugins: Plugins | None = None,
    **settings: Any,
) -> StudyPlan:
    """Return the runs that :func:`run_study` would execute, with estimated time and disk space.

    Nothing is written.

    Args:
        study: As for :func:`run_study`, like all other arguments.
        out: The study's directory.
        workers: Number of parallel runs; 0: one per core.
        retry: Repeat failed runs.
        tables: Paths of ``rows.csv`` of other sessions.
        modules: Local plugins.
        plugins: The plugins for reading the study.
        **settings: Settings by key.

    Raises:
        ConfigurationError: The study is not valid.
        InputError: The directory is not that of this study, or a run or table in it is damaged.
    """
    study, directory = _open(study, out, tuple(modules), plugins, settings)
    if directory.exists():
        refuse_another(study, directory)
    imported = imported_rows(study, directory, map(Path, tables))
    statuses = survey(study, directory, imported, rows=True)
    found = StudyResult(study, directory, statuses, gather(statuses, imported))
    to_run = tuple(found.unfinished(retry=retry))
    _warn_of_generations(found, to_run)
    cores = max(1, min(workers or available_cores(), available_cores(), len(to_run)))
    seconds = {run: row.seconds for run, row in found.finished.items()}
    return StudyPlan(found, to_run, cores, estimate_cost(to_run, seconds))


def _warn_of_generations(found: StudyResult, to_run: Iterable[Planned]) -> None:
    """Warn if finished runs and those to run have results of different bit generations."""
    mixed = mixed_generations(found.rows, to_run)
    if mixed:
        _log.warning(
            "the runs in %s have results of different bit generations (%s); for a study of one generation, "
            "choose another directory (out)",
            found.directory,
            "; ".join(mixed),
        )


def _open(
    study: str | Path | Study,
    out: str | Path | None,
    modules: tuple[str, ...],
    plugins: Plugins | None,
    settings: Mapping[str, Any],
) -> tuple[Study, Path]:
    """Return a study and its directory."""
    if not isinstance(study, Study):
        study = read_study(study, layers_of(settings), plugins or discover(modules))
    elif settings:
        raise TypeError("a study that was read takes no settings; pass them to read_study")
    return study, Path("studies") / study.label if out is None else Path(out)
