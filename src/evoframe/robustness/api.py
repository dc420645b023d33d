"""Robustness from Python: champions of runs and studies, bodies in files, and published bodies."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import layers_of, read_layers
from evoframe.contract import Design, FileOptions, Score, SupportsRandomControllers, unit_of
from evoframe.documents import as_read
from evoframe.errors import ConfigurationError
from evoframe.evolution import score_designs
from evoframe.record import Run
from evoframe.registry import Plugins, discover
from evoframe.robustness.candidates import Candidates, champions, read_candidates
from evoframe.robustness.measurement import Bench, Body, Robustness, Setting, digest_of, draw_controller

__all__ = [
    "Measurable",
    "first_simulation",
    "measurable",
    "measure",
    "measure_robustness",
    "setting_of",
]


def measure_robustness(  # noqa: PLR0913 - the options of the command
    *sources: Run | str | Path,
    controllers: int = 1000,
    published: bool = False,
    seed: int = 1,
    preset: str | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    options: FileOptions | None = None,
    **settings: Any,
) -> Robustness:
    """Simulate bodies with the same random controllers, as the command ``evoframe robustness`` does.

    Nothing is written; ``evoframe.analysis.robustness`` provides statistics, figure and files.

    Args:
        *sources: Runs or their directories (for their champions), directories of studies (for the champions
            of their finished runs), and files with designs.
        controllers: Number of random controllers.
        published: Whether to add the published bodies of the simulator.
        seed: Seed from which all random controllers derive.
        preset: The preset that simulates all bodies; by default, a champion is simulated as in its run.
        workers: Overrides ``executor.workers``; the result does not depend on it.
        plugins: The plugins to choose from; by default the installed ones.
        options: Choices for reading files, such as their dialect.
        **settings: Further settings by key, as for :func:`evoframe.runs.execution`.

    Raises:
        ConfigurationError: The settings are not valid, or the simulator does not draw controllers.
        InputError: A source cannot be read, there are no bodies, or they cannot be compared.
        RunError: The measurement failed.
    """
    paths = [source.directory if isinstance(source, Run) else Path(source) for source in sources]
    overrides = layers_of(settings, {"executor.workers": workers})
    base = None if preset is None else read_layers(preset)
    candidates = read_candidates(
        paths, base, overrides, plugins or discover(), published=published, options=options
    )
    return measure(candidates, setting_of(candidates, seed, controllers))


@attrs.frozen
class Measurable:
    """A champion whose robustness can be measured.

    Attributes:
        digest: As in :class:`~evoframe.robustness.measurement.Body`.
        simulation: The tables ``simulator`` and ``objective`` of its run, as JSON values.
    """

    digest: str
    simulation: Mapping[str, Any]


def measurable(directory: Path, plugins: Plugins) -> Iterator[Measurable]:
    """Yield the champion of a run, or the champions of a study's finished runs.

    Their simulations may differ; champions whose simulator does not draw controllers are skipped.

    Raises:
        ConfigurationError: A champion cannot be read with these plugins.
        InputError: A run is damaged.
    """
    for part in champions(directory, plugins):
        simulator = part.config.simulator.component
        if isinstance(simulator, SupportsRandomControllers):
            simulation = as_read(part.config.simulation())
            for body in part.bodies:
                yield Measurable(digest_of(simulator, body.design), simulation)


def setting_of(candidates: Candidates, seed: int, controllers: int) -> Setting:
    """Return the setting of a measurement, which determines its result.

    Raises:
        ConfigurationError: The seed or the number of controllers is out of range.
    """
    config = candidates.config
    bodies = [
        Body(
            body.label, body.group, digest_of(_simulator(candidates), body.design), body.source, body.dialect
        )
        for body in candidates.bodies
    ]
    unit = unit_of(config.objective.component)
    try:
        return Setting(seed, controllers, unit, config.simulation(), tuple(bodies))
    except (TypeError, ValueError) as error:
        raise ConfigurationError(
            f"expected controllers >= 1 and seed >= 0, found {controllers!r} and {seed!r}"
        ) from error


def first_simulation(candidates: Candidates, setting: Setting) -> tuple[Design, Score]:
    """Return the first body with the first controller, and its score.

    Raises:
        InputError: The simulator cannot simulate the body.
        RunError: The simulator or the objective fails.
    """
    simulator, objective = _simulator(candidates), candidates.config.objective.component
    design = draw_controller(simulator, candidates.bodies[0].design, setting.seed, 0)
    [score] = score_designs(simulator, [design], objective.record, objective)
    return design, score


def measure(
    candidates: Candidates, setting: Setting, on_progress: Callable[[int], None] = lambda _: None
) -> Robustness:
    """Simulate all bodies with all controllers.

    Args:
        candidates: The bodies and their configuration.
        setting: The setting of the same bodies.
        on_progress: Called repeatedly with the number of simulations finished since its last call.

    Raises:
        InputError: The simulator cannot simulate a body.
        RunError: The measurement failed.
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
    simulator: Any = candidates.config.simulator.component  # draws controllers: read_candidates checks it
    found: SupportsRandomControllers = simulator
    return found
