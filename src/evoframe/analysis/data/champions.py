"""What is shown of a run's champion: its body as it moves, and the networks that drew it."""

from __future__ import annotations

from collections.abc import Iterator

import attrs

from evoframe.analysis.data.geometries import checked
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

_FRAMES = 90  # enough for a smooth playback, few enough for a page


@attrs.frozen(eq=False)
class DrawnNetwork:
    """The network of one of the champion's genomes.

    Attributes:
        population: Whose genome it is.
        graph: The network.
        inputs: What its inputs are called; empty if the encoder does not say.
        outputs: What its outputs are called; empty if the encoder does not say.
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
        unit: Of the score.
        geometry: How it looks as it is simulated; ``None`` if its simulator does not say.
        track: The point that its objective looks at; ``None`` if it is none that is drawn.
        networks: Of the populations whose evolvers say what their networks look like.
        verification: What is left of its score with one thing changed; ``None`` if nobody has looked.
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
    """Return what is shown of the champion of a run.

    Raises:
        ConfigurationError: The run cannot be read with these plugins.
        InputError: It has no champion yet, or is damaged.
        ComponentError: What its simulator or an evolver gives cannot be drawn.
    """
    job = read_job(run, None, (), plugins)
    [design], config = job.designs, job.config
    simulator, objective = config.simulator.component, config.objective.component
    with naming(run.directory), blaming("simulator"):
        geometry = (
            checked(simulator.geometry(design, _FRAMES)) if isinstance(simulator, SupportsGeometry) else None
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
                raise InputError(f"{run.directory}: the champion's genome of '{name}': {error}") from error
        inputs = encoder.input_names if isinstance(encoder, SupportsInputNames) else ()
        outputs = encoder.output_names if isinstance(encoder, SupportsOutputNames) else ()
        yield DrawnNetwork(name, drawn, inputs, outputs)
