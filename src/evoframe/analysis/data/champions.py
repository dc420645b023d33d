"""The champion of a run as reports show it: its moving body, and the networks that encode it."""

from __future__ import annotations

from collections.abc import Iterator

import attrs

from evoframe.analysis.data.geometries import validate_geometry
from evoframe.analysis.data.samples import Sample, samples_of
from evoframe.contract import (
    Geometry,
    NetworkGraph,
    RunConfig,
    SupportsGeometry,
    SupportsGraph,
    SupportsInputNames,
    SupportsOutputNames,
    blaming,
    unit_of,
)
from evoframe.designs import naming, read_job
from evoframe.errors import InputError
from evoframe.record import Run, Verification
from evoframe.registry import Plugins

__all__ = ["ChampionData", "DrawnNetwork", "load_champion"]

_FRAMES = 90  # smooth playback at a moderate page size


@attrs.frozen(eq=False)
class DrawnNetwork:
    """The network of one of the champion's genomes.

    Attributes:
        population: Population of the genome.
        graph: The network.
        inputs: Names of its inputs; empty if the encoder does not provide them.
        outputs: Names of its outputs; empty if the encoder does not provide them.
    """

    population: str
    graph: NetworkGraph
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


@attrs.frozen(eq=False)
class ChampionData:
    """The champion of a run.

    Attributes:
        score: Its score.
        unit: Unit of the score.
        geometry: Its geometry over the simulated time; ``None`` if the simulator does not support geometries.
        track: Name of the point that the objective records; ``None`` if the geometry does not have it.
        networks: Networks of the populations whose evolvers support graphs.
        verification: The champion's scores with one setting changed at a time; ``None`` if they were not
            measured.
        samples: Samples of the track that the objective compares, if it selects some.
    """

    score: float
    unit: str
    geometry: Geometry | None
    track: str | None
    networks: tuple[DrawnNetwork, ...]
    verification: Verification | None
    samples: tuple[Sample, ...] = ()


def load_champion(run: Run, plugins: Plugins) -> ChampionData:
    """Load the champion of a run.

    Raises:
        ConfigurationError: The run cannot be read with these plugins.
        InputError: The run has no champion yet, or is damaged.
        ComponentError: The simulator or an evolver fails, or returns something that cannot be drawn.
    """
    job = read_job(run, None, (), plugins)
    [design], config = job.designs, job.config
    simulator, objective = config.simulator.component, config.objective.component
    with naming(run.directory), blaming("simulator"):
        geometry = (
            validate_geometry(simulator.geometry(design, _FRAMES))
            if isinstance(simulator, SupportsGeometry)
            else None
        )
        drawn = geometry.tracks if geometry else {}
        track = next((track for track in objective.record.tracks if track in drawn), None)
        samples = () if track is None else samples_of(simulator, objective, design, track)
    return ChampionData(
        score=run.champion().score,
        unit=unit_of(objective),
        geometry=geometry,
        track=track,
        networks=tuple(_networks(run, config)),
        verification=run.verification(),
        samples=samples,
    )


def _networks(run: Run, config: RunConfig) -> Iterator[DrawnNetwork]:
    for name, genome in run.champion().genomes.items():
        population = config.populations.get(name)
        if population is None or not isinstance(population.evolver.component, SupportsGraph):
            continue
        encoder = population.encoder.component
        with blaming(f"populations.{name}.evolver"):
            try:
                drawn = population.evolver.component.graph(genome, encoder.inputs, encoder.outputs)
            except ValueError as error:
                raise InputError(
                    f"the champion's genome is damaged: {error}", source=run.directory, key=name
                ) from error
        inputs = encoder.input_names if isinstance(encoder, SupportsInputNames) else ()
        outputs = encoder.output_names if isinstance(encoder, SupportsOutputNames) else ()
        yield DrawnNetwork(name, drawn, inputs, outputs)
