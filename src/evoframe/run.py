"""The one place where configuration, plugins, loop and store meet."""

from __future__ import annotations

import contextlib
import itertools
import platform
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from evoframe._version import __version__
from evoframe.coevolution import Coevolution
from evoframe.config import RunConfig, load_config
from evoframe.evaluation import Evaluator
from evoframe.layers import Tree
from evoframe.loading import Run, load_run
from evoframe.observers import Observers
from evoframe.plugins import Plugins
from evoframe.population import Population
from evoframe.randomness import stream
from evoframe.store import Store

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
    if seed is not None:
        settings["run.seed"] = seed
    if workers is not None:
        settings["executor.workers"] = workers
    if isinstance(config, RunConfig):
        if settings:
            raise TypeError("settings cannot be changed after load_config; give them to load_config")
    else:
        config = load_config(config, tables=_nested(settings), plugins=plugins)
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
        store = Store(directory, list(config.populations), simulation_tables(config))
        stack.callback(store.close)
        coevolution = assemble(config)
        stack.callback(coevolution.close)
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
        observers.tell("evoframe_turn_finished", turn=turn)
        if stop():
            break
    if coevolution.turn < coevolution.length:
        return False
    store.finish(_result(coevolution))
    return True


def _result(coevolution: Coevolution) -> dict[str, Any]:
    """Return the final figures: the fittest of each population, and the displacement of that pair."""
    pair = coevolution.fittest_pair()
    names = [population.name for population in coevolution.populations]
    members = [population.members[population.fittest()] for population in coevolution.populations]
    return {
        "turns": coevolution.turn,
        "best_pair_displacement": coevolution.best_score,
        "fittest": {
            name: {"genome": member.id, "fitness": member.fitness}
            for name, member in zip(names, members, strict=True)
        },
        "fittest_pair_displacement": pair.score,
    }


def _provenance(config: RunConfig) -> str:
    """Return the table that says what the run was made with; it is read by people, and by resume."""
    components = dict(config.components())
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for chosen in components.values():
        if hasattr(chosen.component, "provenance"):
            libraries |= chosen.component.provenance()
    vectors = np.show_config(mode="dicts")["SIMD Extensions"]
    table = {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in components.items()},
    }
    return "\n" + tomli_w.dumps({"provenance": table})


def _nested(settings: dict[str, Any]) -> Tree:
    tree: Tree = {}
    for dotted, value in settings.items():
        *folders, key = dotted.split(".")
        table = tree
        for folder in folders:
            table = table.setdefault(folder, {})
        table[key] = value
    return tree
