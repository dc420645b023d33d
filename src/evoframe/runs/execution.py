"""Execution of a run: every turn of the loop is saved and reported to observers."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract import RunConfig, SupportsVariants, Turn, fitness_unit_of, unit_of
from evoframe.designs import verify_designs
from evoframe.errors import ComponentError, RunError
from evoframe.evolution import Coevolution
from evoframe.files import locked
from evoframe.messages import cause_of, quantity
from evoframe.record import Run, Store, Verification, keep_verification
from evoframe.registry import Observers, Plugins
from evoframe.runs.blame import completed

__all__ = ["Execution", "verify_champion"]

_log = logging.getLogger(__name__)


@attrs.frozen
class Execution:
    """A run ready to start or resume: its components are started, and its directory is locked.

    Attributes:
        config: The configuration.
        plugins: The plugins, which can observe the run.
        directory: The run's directory.
    """

    config: RunConfig
    plugins: Plugins
    directory: Path
    _tables: Mapping[str, Any]
    _coevolution: Coevolution
    _store: Store

    @property
    def last_turn(self) -> int | None:
        """Index of the last saved turn; ``None`` if no turn is saved."""
        return None if self._store.last_turn < 0 else self._store.last_turn

    def play(self, stop: Callable[[], bool] = lambda: False) -> Run:
        """Execute the run to its end; can be called once.

        Args:
            stop: Called after every turn; ``True`` stops the run there.

        Returns:
            The run, finished unless it was stopped.

        Raises:
            RunError: The run cannot continue; saved turns are kept.
        """
        observers = Observers(self.plugins.manager)
        with contextlib.ExitStack() as stack:
            stack.enter_context(self._add_hints())
            stack.callback(self._store.close)
            stack.enter_context(self._coevolution)
            observers.tell("evoframe_run_started", config=self.config, directory=self.directory)
            try:
                self._play(observers, stop)
            finally:
                completed = self._store.finished
                observers.tell("evoframe_run_finished", directory=self.directory, completed=completed)
            return Run(self.directory, dict(self._tables), tables=self._store.tables())

    def verify(self, run: Run) -> Verification | None:
        """Verify the champion of the finished run: see :func:`verify_champion`."""
        return verify_champion(self.config, run)

    def _play(self, observers: Observers, stop: Callable[[], bool]) -> None:
        saving = _Saving(self._store, self._coevolution.state, observers, self.config)
        self._coevolution.on_simulating = saving.complete
        try:
            for turn in self._coevolution:
                saving.begin(turn, self._coevolution.reproducing_next)
                if stop():
                    break
        finally:
            saving.complete()
        if self._coevolution.finished:
            self._store.finish(_final_figures(self._coevolution))
        else:
            self._store.update_champion()

    @contextlib.contextmanager
    def _add_hints(self) -> Iterator[None]:
        """Add to an error the component that caused it, and the command that resumes the run."""
        todo = f"after fixing this, continue with: evoframe resume {self.directory}"
        hint = f"saved turns are kept in {self.directory}; {todo}"
        try:
            yield
        except ComponentError as error:
            complete = completed(error, self.config, f"turn {self._store.last_turn + 1}")
            complete.add_note(hint)
            raise complete from error
        except RunError as error:
            error.add_note(hint)
            raise


@attrs.define
class _Saving:
    """The saving of turns, each while the next one is simulated.

    A kill in between loses a turn that is complete, and a resumed run repeats it.
    """

    _store: Store
    _state: Callable[[Collection[str]], Mapping[str, Any]]
    _observers: Observers
    _config: RunConfig
    _unsaved: Turn | None = None

    def begin(self, turn: Turn, reproducing_next: Collection[str]) -> None:
        """Take over a turn; populations that reproduce in the next one change their part of the state."""
        self.complete()  # the turn before, if no worker has simulated anything since
        self._unsaved = turn
        if any(report.population in reproducing_next for report in turn.reports):
            self.complete()

    def complete(self) -> None:
        """Save the turn unless it is saved, and report it to the observers."""
        if self._unsaved is None:
            return
        turn = self._unsaved
        self._unsaved = None  # even if it cannot be saved
        self._store.save(turn, self._state([report.population for report in turn.reports]))
        _log_turn(turn, self._config)
        self._observers.tell("evoframe_turn_finished", turn=turn)


def verify_champion(config: RunConfig, run: Run) -> Verification | None:
    """Verify the champion of a finished run, and write the result to the run's directory.

    Returns:
        The verification; ``None`` if the simulator offers no variants.

    Raises:
        LockedError: Another process is writing to the directory.
        RunError: The verification fails; the run itself is complete and saved.
    """
    if not isinstance(config.simulator.component, SupportsVariants):
        return None
    with locked(run.directory):
        try:
            champion = run.champion()
            [verification] = verify_designs(config, [champion.design], champion.score)
            keep_verification(run.directory, verification)
        except Exception as error:
            problem = f"the run is complete and saved, but its champion cannot be verified: {cause_of(error)}"
            raise RunError(problem, source=run.directory) from error
    return verification


def _log_turn(turn: Turn, config: RunConfig) -> None:
    if turn.best_pair is not None:
        unit = unit_of(config.objective.component)
        _log.info("turn %d: new best pair, score %s", turn.index, quantity(turn.best_pair.score, unit))
    for report in turn.reports:
        unit = fitness_unit_of(config, report.population)
        best, mean = quantity(report.best, unit), quantity(report.mean, unit)
        _log.debug("turn %d: %s: best fitness %s, mean %s", turn.index, report.population, best, mean)


def _final_figures(coevolution: Coevolution) -> dict[str, Any]:
    """Return the final figures: best score, the fittest of each population, and the score of that pair."""
    pair = coevolution.fittest_pair()
    names = [population.name for population in coevolution.populations]
    members = [population.members[population.fittest()] for population in coevolution.populations]
    return {
        "turns": coevolution.length,
        "best_pair_score": coevolution.best_score,
        "fittest": {
            name: {"genome_id": member.id, "fitness": member.fitness}
            for name, member in zip(names, members, strict=True)
        },
        "fittest_pair_score": pair.score,
    }
