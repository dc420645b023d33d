"""Studies from Python: run what is missing, or find out what that would take."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import layers_of
from evoframe.registry import Plugins, discover
from evoframe.study.conduct import Watcher, claim, execute, lock_tables, refuse_another, survey
from evoframe.study.estimate import Estimate, estimate_cost
from evoframe.study.gathered import gather, import_rows, imported_rows
from evoframe.study.plan import Planned, Study, read_study
from evoframe.study.pool import Pool
from evoframe.study.progress import Status
from evoframe.study.rows import ROWS_FILE, Row, write_rows
from evoframe.study.worker import Order
from evoframe.workers import available_cores

__all__ = ["StudyPlan", "StudyResult", "plan_study", "run_study"]


@attrs.frozen
class StudyResult:
    """The state of a study, and the rows of its finished runs.

    Attributes:
        study: The study.
        directory: Its directory.
        statuses: How far each run is, in the order of work.
        rows: Row of each run that is finished or imported, in the order of work.
    """

    study: Study
    directory: Path
    statuses: Mapping[Planned, Status] = attrs.field(repr=False)
    rows: Mapping[Planned, Row] = attrs.field(repr=False)

    @property
    def failed(self) -> dict[Planned, str]:
        """The runs that have failed, with the cause of each."""
        return {run: status.cause for run, status in self.statuses.items() if status.state == "failed"}

    @property
    def left(self) -> list[Planned]:
        """The runs that are not finished and verified: failed, interrupted, or left to another process."""
        return [run for run, status in self.statuses.items() if not status.is_complete]

    @property
    def finished(self) -> dict[Planned, Row]:
        """The rows of the runs that are finished in this directory, not imported."""
        return {run: row for run, row in self.rows.items() if self.statuses[run].state == "finished"}

    @property
    def unverified(self) -> list[Planned]:
        """The finished runs whose champions are not verified yet."""
        return [run for run in self.finished if not self.statuses[run].verified]

    def unfinished(self, *, retry: bool = False) -> list[Planned]:
        """Return the runs to start or to resume; with *retry* those that failed, too."""
        states = ("missing", "begun", "failed") if retry else ("missing", "begun")
        return [run for run, status in self.statuses.items() if status.state in states]


@attrs.frozen
class StudyPlan:
    """What a study would run.

    Attributes:
        found: What is there already.
        to_run: The runs that would be started or resumed.
        cores: The number of cores that would have something to do.
        estimate: What the runs would take.
    """

    found: StudyResult
    to_run: tuple[Planned, ...]
    cores: int
    estimate: Estimate


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
    """Run what is missing of a study, as the command ``evoframe study`` does.

    Interrupted runs are resumed, and champions that were not verified are verified; what is finished stays as
    it is. Each run has a process of its own: a script calls this under ``if __name__ == "__main__":``.

    Args:
        study: Name of a study that comes with evoframe, path of a TOML file, or a study from
            :func:`read_study`.
        out: The study's directory; by default ``studies/<label>``.
        workers: Number of parallel runs; 0: one per core.
        retry: Run what has failed once more.
        tables: Paths of ``rows.csv`` of other sessions, whose rows count as finished runs.
        modules: Local plugins, importable names or ``.py`` files, for this process and those of the runs.
        plugins: The plugins to read the study with; by default those that are installed, and *modules*.
        watcher: Receives the progress.
        stop: Asked several times a second whether to stop after the turns in progress.
        **settings: Settings by key, as for :func:`evoframe.run`; ``runs`` and ``grid`` among them.

    Returns:
        All that there is of the study. A run that fails is reported there, and the others go on.

    Raises:
        ConfigurationError: The study cannot be accepted; nothing was run or written.
        InputError: The directory is that of something else, or a run or table in it is damaged.
        RunError: A file of the study cannot be written.
        KeyboardInterrupt: Runs were interrupted at once; what they have saved stays, and the rows of the
            finished ones are written. Not raised if *stop* asks to stop anyway.
    """
    modules, paths, watcher = tuple(modules), [Path(path) for path in tables], watcher or Watcher()
    study, directory = _opened(study, out, modules, plugins, settings)
    claim(study, directory)
    with lock_tables(directory) if paths else contextlib.nullcontext():
        imported = (import_rows if paths else imported_rows)(study, directory, paths)
    statuses = survey(study, directory, imported, rows=True)
    found = StudyResult(study, directory, statuses, gather(statuses, imported))
    todo = [*found.unverified, *found.unfinished(retry=retry)]
    watcher.on_begin(study, todo, {run: row for run, row in found.rows.items() if statuses[run].is_complete})
    orders = {run: Order(run.directory, study.layers_of(run), study.label, modules) for run in todo}
    try:
        with contextlib.closing(Pool(workers or available_cores())) as pool:
            execute(orders, pool, watcher, stop)
    except KeyboardInterrupt:
        if not stop():
            raise
    finally:
        settled = {run: statuses[run] for run in found.finished if statuses[run].is_complete}
        with lock_tables(directory):  # so that the last process to write has seen what all of them made
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
    """Return what :func:`run_study` would run, with estimated time and disk space; write nothing.

    Args:
        study: As for :func:`run_study`, like all others.
        out: The study's directory.
        workers: Number of parallel runs; 0: one per core.
        retry: Run what has failed once more.
        tables: Paths of ``rows.csv`` of other sessions.
        modules: Local plugins.
        plugins: The plugins to read the study with.
        **settings: Settings by key.

    Raises:
        ConfigurationError: The study cannot be accepted.
        InputError: The directory is that of something else, or a run or table in it is damaged.
    """
    study, directory = _opened(study, out, tuple(modules), plugins, settings)
    if directory.exists():
        refuse_another(study, directory)
    imported = imported_rows(study, directory, map(Path, tables))
    statuses = survey(study, directory, imported, rows=True)
    found = StudyResult(study, directory, statuses, gather(statuses, imported))
    to_run = tuple(found.unfinished(retry=retry))
    cores = max(1, min(workers or available_cores(), available_cores(), len(to_run)))
    seconds = {run: row.seconds for run, row in found.finished.items()}
    return StudyPlan(found, to_run, cores, estimate_cost(to_run, seconds))


def _opened(
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
        raise TypeError("a study is complete; give settings to read_study")
    return study, Path("studies") / study.label if out is None else Path(out)
