"""Progress of a run: a bar on a terminal, otherwise a line every few seconds."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path

from rich import progress
from rich.console import RenderableType
from rich.text import Text

from evoframe.cli.context import messages
from evoframe.contract import RunConfig, Turn, fitness_unit_of
from evoframe.evolution import timing_of
from evoframe.messages import quantity
from evoframe.registry import hookimpl

__all__ = ["Progress", "bar_columns"]

_LINE_INTERVAL = 5.0  # s
_BAR_INTERVAL = 0.25  # s; drawing costs as much as a simulation or two


class Progress:
    """An observer that reports progress on standard error."""

    def __init__(self) -> None:
        self._console = messages()
        self._bar: _Bar | None = None
        self._task = progress.TaskID(0)
        self._best: dict[str, float] = {}
        self._units: dict[str, str] = {}
        self._turns = self._pairs = self._simulations = 0
        self._started = self._shown = time.monotonic()

    @hookimpl
    def evoframe_run_started(self, config: RunConfig, directory: Path) -> None:
        """Print the name, seed and directory of the run."""
        self._turns = timing_of(config).length
        self._units = {population: fitness_unit_of(config, population) for population in config.populations}
        self._started = self._shown = time.monotonic()
        self._console.print(
            f"{config.label}, seed {config.run.seed}: {self._turns} turns, saved in {directory}",
            soft_wrap=True,
        )
        if self._console.is_terminal:
            self._bar = _Bar(
                *bar_columns("{task.description}"),
                console=self._console,
                transient=True,
                refresh_per_second=1 / _BAR_INTERVAL,
                expand=True,
            )
            self._task = self._bar.add_task("turn 0", total=self._turns + 1, detail="")
            self._bar.start()

    @hookimpl
    def evoframe_turn_finished(self, turn: Turn) -> None:
        """Show the turn, the best fitness of each population, the rate and the share of cached scores."""
        self._pairs += turn.workload.pairs
        self._simulations += turn.workload.simulations
        self._best |= {report.population: report.best for report in turn.reports}
        now = time.monotonic()
        interval = _LINE_INTERVAL if self._bar is None else _BAR_INTERVAL
        if now - self._shown >= interval or turn.index == self._turns:
            self._shown = now
            self._show(turn, now)

    @hookimpl
    def evoframe_run_finished(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()

    def _show(self, turn: Turn, now: float) -> None:
        done = f"turn {turn.index}/{self._turns}" if turn.reports else "final pair"
        if self._bar is None:
            seconds = (now - self._started) / (turn.index + 1) * (self._turns - turn.index)
            self._console.print(f"{done}  {self._detail(now)}  {seconds:.0f} s left", soft_wrap=True)
        else:
            self._bar.update(self._task, completed=turn.index + 1, description=done, detail=self._detail(now))

    def _detail(self, now: float) -> str:
        best = "  ".join(
            f"{population} {quantity(fitness, self._units.get(population, ''))}"
            for population, fitness in self._best.items()
        )
        rate = self._simulations / max(now - self._started, 1e-9)
        cached = 1 - self._simulations / self._pairs
        return f"best fitness: {best}  {rate:.0f} simulations/s  {cached:.0%} of pairs cached"


class _Bar(progress.Progress):
    """A bar with the turn and the time left, and a line of details below it."""

    def get_renderables(self) -> Iterable[RenderableType]:
        yield self.make_tasks_table(self.tasks)
        yield from (Text(task.fields["detail"], overflow="ellipsis", no_wrap=True) for task in self.tasks)


def bar_columns(text: str) -> Sequence[progress.ProgressColumn]:
    """Return the columns of a bar: *text* with fields of the task, the bar, and the time left."""
    return (
        progress.TextColumn(text),
        progress.BarColumn(bar_width=None),
        progress.TimeRemainingColumn(),
        progress.TextColumn("left"),
    )
