"""Robustness of what a person names: the champions of runs and studies, bodies of files, published bodies."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import layers_of
from evoframe.contract import SupportsRandomControllers, unit_of
from evoframe.documents import as_read
from evoframe.errors import ConfigurationError
from evoframe.record import Run
from evoframe.registry import Plugins, discover
from evoframe.robustness.candidates import Candidates, champions, read_candidates
from evoframe.robustness.measurement import Bench, Body, Robustness, Setting, digest_of

__all__ = ["Measurable", "measurable", "measure", "measure_robustness", "setting_of"]


def measure_robustness(  # noqa: PLR0913 - the options of the command
    *sources: Run | str | Path,
    controllers: int = 1000,
    published: bool = False,
    seed: int = 1,
    preset: str | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    **settings: Any,
) -> Robustness:
    """Simulate bodies with the same random controllers, as the command ``evoframe robustness`` does.

    Nothing is written; ``evoframe.analysis.robustness`` has the statistics, the figure and the files.

    Args:
        *sources: Runs or their directories, which stand for their champions; directories of studies, which
            stand for the champions of their finished runs; and files with designs.
        controllers: How many are drawn.
        published: Whether the bodies that the simulator brings join.
        seed: All controllers derive from it, and from nothing else.
        preset: With which all are simulated; a champion otherwise as in its run.
        workers: Overrides ``executor.workers``; the result does not depend on it.
        plugins: The plugins to choose from; by default those that are installed.
        **settings: Further settings by key, as for :func:`evoframe.runs.execution`.

    Raises:
        ConfigurationError: The settings cannot be accepted, or the simulator draws no controllers.
        InputError: Something cannot be read, there is no body, or the bodies do not fit together.
        RunError: The measurement cannot be made.
    """
    paths = [source.directory if isinstance(source, Run) else Path(source) for source in sources]
    overrides = layers_of({**settings, "executor.workers": workers})
    candidates = read_candidates(paths, preset, overrides, plugins or discover(), published=published)
    return measure(candidates, setting_of(candidates, seed, controllers))


@attrs.frozen
class Measurable:
    """A champion that could be measured.

    Attributes:
        digest: As of a :class:`~evoframe.robustness.measurement.Body`.
        simulation: How it is simulated in its run: the tables ``simulator`` and ``objective``, as in JSON.
    """

    digest: str
    simulation: Mapping[str, Any]


def measurable(directory: Path, plugins: Plugins) -> Iterator[Measurable]:
    """Return the champions of a run, or of the finished runs of a study that are there.

    They need not be simulated alike; those whose simulator draws no controllers are left out.

    Raises:
        ConfigurationError: One of them cannot be read with these plugins.
        InputError: One of them is damaged.
    """
    for part in champions(directory, plugins):
        simulator = part.config.simulator.component
        if isinstance(simulator, SupportsRandomControllers):
            simulation = as_read(part.config.simulation())
            for body in part.bodies:
                yield Measurable(digest_of(simulator, body.design), simulation)


def setting_of(candidates: Candidates, seed: int, controllers: int) -> Setting:
    """Return all that decides a measurement, before it is made.

    Raises:
        ConfigurationError: There is no such seed or number of controllers.
    """
    config = candidates.config
    bodies = [
        Body(body.label, body.group, digest_of(_simulator(candidates), body.design), body.source)
        for body in candidates.bodies
    ]
    unit = unit_of(config.objective.component)
    try:
        return Setting(seed, controllers, unit, config.simulation(), tuple(bodies))
    except (TypeError, ValueError) as error:
        raise ConfigurationError(
            f"expected 1 or more controllers and a seed from 0 up, found {controllers!r} and {seed!r}"
        ) from error


def measure(
    candidates: Candidates, setting: Setting, on_progress: Callable[[int], None] = lambda _: None
) -> Robustness:
    """Simulate all bodies with all controllers.

    Args:
        candidates: The bodies, and what simulates them.
        setting: Of the same bodies.
        on_progress: Called now and then with the number of simulations done since the last time.

    Raises:
        InputError: The simulator cannot simulate a body.
        RunError: The measurement cannot be made.
    """
    config = candidates.config
    workers = config.executor.component.start()
    try:
        designs = [body.design for body in candidates.bodies]
        bench = Bench(_simulator(candidates), config.objective.component, workers)
        return bench.measure(setting, designs, on_progress)
    finally:
        workers.close()


def _simulator(candidates: Candidates) -> SupportsRandomControllers:
    simulator: Any = candidates.config.simulator.component  # which draws controllers, as all candidates' do
    found: SupportsRandomControllers = simulator
    return found
