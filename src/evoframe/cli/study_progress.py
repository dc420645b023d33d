"""Progress of a study: a table and a bar on a terminal, otherwise a line for each run."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Self

import attrs
from rich.console import Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from evoframe.cli.context import messages
from evoframe.evolution import timing_of
from evoframe.messages import quantity
from evoframe.study import Cell, End, Planned, Row, Study, Watcher

__all__ = ["StudyProgress", "duration", "table_of_cells"]

_INTERVAL = 0.5  # s between two updates


@attrs.define
class _State:
    """Progress of one configuration."""

    total: int
    done: int = 0
    failed: int = 0
    elsewhere: int = 0
    running: int = 0
    scores: list[float] = attrs.field(factory=list)
    best: float | None = None

    def add(self, score: float) -> None:
        """Count a finished run."""
        self.done += 1
        self.scores.append(score)
        self.saw(score)

    def saw(self, score: float | None) -> None:
        if score is not None:
            self.best = score if self.best is None else max(score, self.best)


class _Work:
    """Work of a study, in pairs, which take nearly all of the time: done in this session, and left.

    Args:
        todo: The runs to start or resume.
    """

    def __init__(self, todo: Iterable[Planned]) -> None:
        self.done = 0.0
        self._left = {planned: float(planned.cell.pairs) for planned in todo}
        self._whole = self.left
        self._seen: set[Planned] = set()

    @property
    def left(self) -> float:
        """Pairs left in runs that have not ended."""
        return sum(self._left.values())

    def saw(self, planned: Planned, turn: int) -> None:
        """Count a finished turn; turns before the first one seen were done in an earlier session."""
        config = planned.cell.config
        turns = timing_of(config).length + 1
        pairs = planned.cell.pairs / turns
        if planned not in self._seen:
            self._seen.add(planned)
            self._left[planned] = max(0, turns - turn) * pairs
        left = max(0, turns - turn - 1) * pairs
        self.done += self._left[planned] - left
        self._left[planned] = left

    def ended(self, planned: Planned, *, finished: bool) -> None:
        """Count the end of a run; the remaining pairs of a finished run that was seen running are done."""
        left = self._left.pop(planned)
        if finished and planned in self._seen:
            self.done += left

    def times(self, elapsed: float) -> list[str]:
        """Return rate and time left after *elapsed* seconds; empty if nothing was done."""
        if not self.done or not elapsed:
            return []
        left = duration(elapsed * self.left / self.done)
        return [f"{self.done / elapsed:,.0f} pairs/s", f"{left} left"]

    def bar(self) -> ProgressBar:
        """Return a bar of the work done, in this session and before it."""
        return ProgressBar(total=self._whole or 1, completed=self._whole - self.left)


class StudyProgress(Watcher):
    """Reports the progress of a study on standard error; a context manager that clears its table at the end.

    Args:
        quiet: Whether to report failures only.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._console = messages()
        self._quiet = quiet
        self._headings: Sequence[str] = ()
        self._work = _Work(())
        self._cells: dict[Cell, _State] = {}
        self._started = time.monotonic()
        shown = self._console.is_terminal and not quiet
        self._live = Live(console=self._console, transient=True, auto_refresh=False) if shown else None
        self._drawn = 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._live is not None:
            self._live.stop()

    def on_begin(self, study: Study, todo: Sequence[Planned], done: Mapping[Planned, Row]) -> None:
        """Count the finished runs, and start the display."""
        self._headings, self._work = study.headings, _Work(todo)
        for planned in (*done, *todo):
            self._cells.setdefault(planned.cell, _State(0)).total += 1
        for planned, row in done.items():
            self._cells[planned.cell].add(row.score)
        self._started = time.monotonic()
        if self._live is not None:
            self._live.start()

    def on_run_started(self, planned: Planned) -> None:
        """Count a run as running."""
        self._cells[planned.cell].running += 1

    def on_turn_finished(self, planned: Planned, turn: int, best: float | None) -> None:
        """Count a turn of a run."""
        self._work.saw(planned, turn)
        self._cells[planned.cell].saw(best)

    def on_run_ended(self, planned: Planned, end: End) -> None:
        """Count the end of a run; print a line if there is no table."""
        state = self._cells[planned.cell]
        state.running -= 1
        self._work.ended(planned, finished=end.state == "finished")
        if end.score is not None:
            state.add(end.score)
        elif end.state == "failed":
            state.failed += 1
        elif end.state == "elsewhere":
            state.elsewhere += 1
        if end.state == "failed" or not (self._quiet or self._live is not None):
            what = f"failed: {end.cause}" if end.state == "failed" else end.state
            best = "" if end.score is None else f", best pair {quantity(end.score, planned.cell.unit)}"
            self._console.print(f"{planned.label}: {what}{best}  {self._tally()}", soft_wrap=True)

    def on_tick(self) -> None:
        """Redraw the table, if there is one."""
        now = time.monotonic()
        if self._live is not None and now - self._drawn >= _INTERVAL:
            self._drawn = now
            table = table_of_cells(self._headings, ("done", "running", "best pair", "median"))
            for cell, state in self._cells.items():
                median = statistics.median(state.scores) if state.scores else None
                table.add_row(
                    *cell.values,
                    f"{state.done}/{state.total}",
                    str(state.running or ""),
                    "" if state.best is None else quantity(state.best, cell.unit),
                    "" if median is None else quantity(median, cell.unit),
                )
            self._live.update(Group(table, Text(self._tally()), self._work.bar()), refresh=True)

    def _tally(self) -> str:
        states = self._cells.values()
        done, total = sum(state.done for state in states), sum(state.total for state in states)
        running, failed = sum(state.running for state in states), sum(state.failed for state in states)
        elsewhere = sum(state.elsewhere for state in states)
        left = total - done - failed - running - elsewhere
        parts = [f"{done}/{total} runs done", f"{running} running", f"{left} left"]
        if failed:
            parts.append(f"{failed} failed")
        if elsewhere:
            parts.append(f"{elsewhere} running in other processes")
        return ", ".join([*parts, *self._work.times(time.monotonic() - self._started)])


def table_of_cells(headings: Sequence[str], figures: Sequence[str]) -> Table:
    """Return an empty table with columns for the keys of the grid, then *figures*."""
    table = Table(box=None, header_style="bold")
    for heading in headings:
        table.add_column(heading, overflow="fold")
    for figure in figures:
        table.add_column(figure, justify="right", no_wrap=True)
    return table


def duration(seconds: float) -> str:
    """Return a duration as displayed: ``40 s``, ``12 min``, ``3 h 20 min``."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
