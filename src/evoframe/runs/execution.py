"""The one place where configuration, plugins, loop and store meet."""

from __future__ import annotations

import contextlib
import functools
import itertools
import logging
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import attrs
import tomli_w

from evoframe.evolution.coevolution import Coevolution
from evoframe.contract.config import RunConfig
from evoframe.errors import (
    ComponentError,
    ConfigurationError,
    EvoframeError,
    InputError,
    NotEmptyError,
    OccupiedError,
    RunError,
)
from evoframe.evolution.evaluation import Evaluator
from evoframe.designs.exporting import exports
from evoframe.config.layers import layers_of
from evoframe.record.run import Run, has_begun, load_run
from evoframe.files.locks import LOCK_FILE, Lock, held, locked, released_on_error
from evoframe.registry.observers import Observers
from evoframe.registry.registry import Plugins
from evoframe.evolution.population import Population
from evoframe.record.provenance import provenance
from evoframe.evolution.randomness import stream
from evoframe.config.resolve import load_config
from evoframe.record.store import CONFIG_FILE, Store, is_leftover, write_atomically, write_json
from evoframe.contract.values import Design, Turn
from evoframe.record.verification import VERIFICATION_FILE, Verification, can_verify, verify_design

_log = logging.getLogger(__name__)

__all__ = [
    "Execution",
    "assemble",
    "evaluator_of",
    "keep_verification",
    "opened_store",
    "prepare",
    "run",
    "verified",
    "verify_champion",
]


def run(
    config: str | Path | RunConfig = "paper",
    /,
    *,
    seed: int | None = None,
    out: str | Path | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    **settings: Any,
) -> Run:
    """Run a configuration to its end and verify its champion, as the command ``evoframe run`` does.

    Args:
        config: Name of a preset, path of a TOML file, or a configuration from :func:`load_config`.
        seed: Overrides ``run.seed``.
        out: The run's directory; by default ``runs/<label>-<seed>``, with a counter if that exists.
        workers: Overrides ``executor.workers``.
        plugins: The plugins to choose from; by default those that are installed.
        **settings: Further settings by key: ``aggregator="hm"``, ``collaboration={"n": 5}``, or dotted,
            ``**{"collaboration.n": 5}``.

    Returns:
        The finished run.

    Raises:
        ConfigurationError: The configuration cannot be accepted; nothing was run or written.
        InputError: The directory is not empty, or cannot be written.
        RunError: The run cannot go on, or its champion cannot be verified; what was saved stays.
    """
    if isinstance(config, RunConfig):
        if settings or any(given is not None for given in (seed, workers, plugins)):
            raise TypeError("a configuration is complete; give settings and plugins to load_config")
    else:
        overrides = layers_of({**settings, "run.seed": seed, "executor.workers": workers})
        config = load_config(config, overrides=overrides, plugins=plugins)
    execution = prepare(config, None if out is None else Path(out))
    execution.play(Observers(config.discovered.manager))
    execution.verify()
    return load_run(execution.directory)


def assemble(config: RunConfig) -> Coevolution:
    """Return the loop that a configuration describes, ready for the first turn."""
    populations = tuple(
        Population(
            name=role,
            encoder=chosen.encoder.component,
            evolver=chosen.evolver.component.start(
                chosen.encoder.component.inputs,
                chosen.encoder.component.outputs,
                chosen.size,
                stream(config.run.seed, f"population/{role}"),
            ),
            rng=stream(config.run.seed, f"collaboration/{role}"),
        )
        for role, chosen in config.populations.items()
    )
    return Coevolution(
        populations=populations,
        strategy=config.collaboration.component,
        aggregator=config.aggregator.component,
        evaluator=evaluator_of(config),
        generations=config.run.generations,
    )


def evaluator_of(config: RunConfig) -> Evaluator:
    """Return what scores designs as a configuration says, its workers ready."""
    return Evaluator(
        config.simulator.component, config.objective.component, config.executor.component.start()
    )


def verified(config: RunConfig, designs: Sequence[Design], score: float | None = None) -> list[Verification]:
    """Return what becomes of designs in all variants of a configuration's simulator.

    Args:
        config: How they are simulated and scored, and by how many workers.
        designs: What is verified, each on its own.
        score: What a champion scored in its run.

    Raises:
        ConfigurationError: The simulator offers no variants.
    """
    simulator = config.simulator.component
    if not can_verify(simulator):
        raise ConfigurationError(
            f"the simulator '{config.simulator.name}' offers no variants of a simulation, so there is "
            "nothing that a score could be compared with"
        )
    workers = config.executor.component.start()
    try:
        return [
            verify_design(simulator, config.objective.component, design, workers, score) for design in designs
        ]
    finally:
        workers.close()


def keep_verification(directory: Path, verification: Verification) -> None:
    """Write the verification of a run's champion beside it, so that :attr:`Run.verification` finds it.

    Raises:
        RunError: It cannot be written.
    """
    write_json(directory / VERIFICATION_FILE, verification.to_json())


@attrs.frozen
class Execution:
    """A run that is about to begin or to go on: its components have started, and its directory is its own.

    Attributes:
        config: What is run.
        directory: Where to.
    """

    config: RunConfig
    directory: Path
    _coevolution: Coevolution
    _store: Store

    def play(self, observers: Observers, stop: Callable[[], bool] = lambda: False) -> bool:
        """Run to the end, once.

        Args:
            observers: Who is told.
            stop: Asked after every turn whether to stop there.

        Returns:
            Whether the run was completed.

        Raises:
            RunError: The run cannot go on; what was saved stays.
        """
        completed = False
        with contextlib.ExitStack() as stack:
            stack.enter_context(self._naming_what_to_do())
            stack.callback(self._store.close)
            stack.enter_context(self._coevolution)
            observers.tell("evoframe_run_started", config=self.config, directory=self.directory)
            try:
                completed = _play(self._coevolution, self._store, observers, stop)
            finally:
                observers.tell("evoframe_run_finished", directory=self.directory, completed=completed)
        return completed

    @contextlib.contextmanager
    def _naming_what_to_do(self) -> Iterator[None]:
        try:
            yield
        except RunError as error:
            todo = f"to go on when that is mended: evoframe resume {self.directory}"
            raise RunError(
                f"{self._in_full(error)}\n  what was saved before stays in {self.directory}; {todo}"
            ) from error

    def _in_full(self, error: RunError) -> str:
        """Return the message of an error; of a component's, with all that is known of the component."""
        chosen = dict(self.config.components()).get(getattr(error, "component", ""))
        if not isinstance(error, ComponentError) or chosen is None:
            return str(error)
        turn = f"turn {self._store.last_turn + 1}"
        about = ", ".join(part for part in (turn, error.concerns) if part)
        return f"{error.component}: '{chosen.name}' (plugin {chosen.source}): {error.problem} ({about})"

    def verify(self) -> Verification | None:
        """Verify the champion of the completed run: see :func:`verify_champion`."""
        return verify_champion(self.config, self.directory)


def verify_champion(config: RunConfig, directory: Path) -> Verification | None:
    """Verify the champion of a completed run, and keep the result beside it.

    Returns:
        The verification; ``None`` if the simulator offers no variants.

    Raises:
        LockedError: Another process writes to the directory.
        RunError: It cannot be done. The run itself is complete and saved.
    """
    if not can_verify(config.simulator.component):
        return None
    with held(directory):
        try:
            champion = load_run(directory).champion
            [verification] = verified(config, [champion.design], champion.score)
            keep_verification(directory, verification)
        except Exception as error:
            cause = str(error) if isinstance(error, EvoframeError) else f"{type(error).__name__}: {error}"
            complete = f"{directory}: the run is complete and saved"
            raise RunError(f"{complete}, but its champion cannot be verified: {cause}") from error
    return verification


def prepare(config: RunConfig, out: Path | None = None) -> Execution:
    """Start the components of a configuration, and make the directory of its run.

    Args:
        config: What to run.
        out: The run's directory, missing or empty; by default ``runs/<label>-<seed>``, with a counter if
            that exists.

    Raises:
        ConfigurationError: A component refuses to start; there is no directory then.
        OccupiedError: The directory holds a run, perhaps one that another process has just begun.
        InputError: It is not empty, or cannot be made.
    """
    coevolution = assemble(config)
    try:
        directory = _default_directory(config) if out is None else _given_directory(out)
        return Execution(config, directory, coevolution, _new_store(directory, config))
    except BaseException:
        coevolution.close()
        raise


def _new_store(directory: Path, config: RunConfig) -> Store:
    lock = locked(directory)
    with released_on_error(lock):
        _refuse_occupied(directory)  # again: another process may have been faster
        text = config.to_toml() + "\n" + tomli_w.dumps({"provenance": provenance(config)})
        write_atomically(directory / CONFIG_FILE, text.encode())
        store = opened_store(directory, config, lock)
        store.begin(list(config.populations), config.deciding())
        return store


def opened_store(directory: Path, config: RunConfig, lock: Lock) -> Store:
    """Return the store of a run's directory, whose database is new or has what was saved so far.

    Raises:
        InputError: It cannot be written.
    """
    export = functools.partial(exports, config.simulator.component)
    return Store.open(directory, config.simulation(), lock, export)


def _default_directory(config: RunConfig) -> Path:
    """Make a directory that was not there before, so that runs which start together do not meet in one."""
    base = Path("runs") / f"{config.label}-{config.run.seed}"
    counted = (base.with_name(f"{base.name}-{number}") for number in itertools.count(2))
    for directory in itertools.chain([base], counted):
        try:
            directory.mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            raise InputError(f"{directory}: cannot be made: {error.strerror}") from error
        return directory
    raise AssertionError  # the counter has no end


def _given_directory(directory: Path) -> Path:
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a run: {error.strerror}") from error
    _refuse_occupied(directory)
    return directory


def _refuse_occupied(directory: Path) -> None:
    try:
        names = {path.name for path in directory.iterdir() if not is_leftover(path)} - {LOCK_FILE}
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a run: {error.strerror}") from error
    if CONFIG_FILE in names:
        finished = has_begun(directory) and load_run(directory).finished
        what = "holds a finished run" if finished else "holds a run that is not finished"
        todo = "" if finished else f"; to go on with it: evoframe resume {directory}"
        raise OccupiedError(
            f"{directory}: is not empty: it {what}; choose another directory with --out{todo}"
        )
    if names:
        raise NotEmptyError(f"{directory}: is not empty; choose another directory with --out")


def _play(coevolution: Coevolution, store: Store, observers: Observers, stop: Callable[[], bool]) -> bool:
    for turn in coevolution:
        changed = [report.population for report in turn.reports]
        store.save(turn, coevolution.state(changed))
        _note(turn)
        observers.tell("evoframe_turn_finished", turn=turn)
        if stop():
            break
    if not coevolution.finished:
        store.update_champion()
        return False
    store.finish(_result(coevolution))
    return True


def _note(turn: Turn) -> None:
    if turn.best_pair is not None:
        _log.info("turn %d: a pair with the score %r", turn.index, turn.best_pair.score)
    for report in turn.reports:
        best, mean = report.best, report.mean
        _log.debug("turn %d: %s: best %r, mean %r", turn.index, report.population, best, mean)


def _result(coevolution: Coevolution) -> dict[str, Any]:
    """Return the final figures: the fittest of each population, and the score of that pair."""
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
