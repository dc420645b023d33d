"""The one place where configuration, plugins, loop and store meet."""

from __future__ import annotations

import contextlib
import itertools
import logging
import platform
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from evoframe._version import __version__
from evoframe.coevolution import Coevolution
from evoframe.config import RunConfig
from evoframe.evaluation import Evaluator
from evoframe.layers import Tree, layer_of
from evoframe.loading import Run, load_run
from evoframe.observers import Observers
from evoframe.plugins import Plugins
from evoframe.population import Population
from evoframe.randomness import stream
from evoframe.resolve import load_config
from evoframe.store import Store
from evoframe.values import Turn

_log = logging.getLogger(__name__)

__all__ = ["assemble", "default_directory", "execute", "run"]


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
    """Run a configuration to its end, as the command ``evoframe run`` does.

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
        RunError: The run cannot go on; what was saved stays.
    """
    if isinstance(config, RunConfig):
        if settings or seed is not None or workers is not None:
            raise TypeError("a configuration is complete; give its settings to load_config")
    else:
        named = {**settings, "run.seed": seed, "executor.workers": workers}
        overrides = [
            layer_of(f"{key}={value!r}", key, value) for key, value in named.items() if value is not None
        ]
        config = load_config(config, overrides=overrides, plugins=plugins)
    directory = Path(out) if out is not None else default_directory(config)
    execute(config, directory)
    return load_run(directory)


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
        evaluator=Evaluator(
            config.simulator.component,
            config.objective.component,
            config.executor.component.start(),
        ),
        generations=config.run.generations,
    )


def default_directory(config: RunConfig) -> Path:
    """Return ``runs/<label>-<seed>``, with a counter if that exists."""
    base = Path("runs") / f"{config.label}-{config.run.seed}"
    counted = (base.with_name(f"{base.name}-{number}") for number in itertools.count(2))
    return next(path for path in itertools.chain([base], counted) if not path.exists())


def execute(
    config: RunConfig,
    directory: Path,
    observers: Observers | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> bool:
    """Run a configuration into a directory.

    Args:
        config: What to run.
        directory: Where to; must be missing or empty.
        observers: Who is told; by default the plugins of the configuration.
        stop: Asked after every turn whether to stop there.

    Returns:
        Whether the run was completed.
    """
    observers = observers or Observers(config.discovered.manager)
    completed = False
    with contextlib.ExitStack() as stack:
        coevolution = stack.enter_context(assemble(config))
        store = Store(directory, list(config.populations), simulation_tables(config))
        stack.callback(store.close)
        store.save_config(config.to_toml() + _provenance(config))
        observers.tell("evoframe_run_started", config=config, directory=directory)
        try:
            completed = _play(coevolution, store, observers, stop)
        finally:
            observers.tell("evoframe_run_finished", directory=directory, completed=completed)
    return completed


def simulation_tables(config: RunConfig) -> Tree:
    """Return the tables that say how a design is simulated and scored."""
    tables = config.tables()
    return {key: tables[key] for key in ("simulator", "objective")}


def _play(coevolution: Coevolution, store: Store, observers: Observers, stop: Callable[[], bool]) -> bool:
    for turn in coevolution:
        changed = [report.population for report in turn.reports]
        store.save(turn, coevolution.state(changed))
        _note(turn)
        observers.tell("evoframe_turn_finished", turn=turn)
        if stop():
            break
    if not coevolution.finished:
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
        "turns": coevolution.turn,
        "best_pair_score": coevolution.best_score,
        "fittest": {
            name: {"genome_id": member.id, "fitness": member.fitness}
            for name, member in zip(names, members, strict=True)
        },
        "fittest_pair_score": pair.score,
    }


def _provenance(config: RunConfig) -> str:
    """Return the table that says what the run was made with; it is read by people, and by resume."""
    components = dict(config.components())
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for chosen in components.values():
        if hasattr(chosen.component, "provenance"):
            libraries |= chosen.component.provenance()
    vectors = np.show_config(mode="dicts").get("SIMD Extensions", {})
    table = {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in components.items()},
    }
    return "\n" + tomli_w.dumps({"provenance": table})
