"""The names of the built-in evolvers, and their optional capabilities."""

from __future__ import annotations

import numpy as np
import pytest

from evoframe import (
    ConfigurationError,
    Evolver,
    SupportsBitGeneration,
    SupportsGraph,
    SupportsLoad,
    SupportsProvenance,
    SupportsSeeds,
)
from evoframe_evolvers import Genetic, Neat, RandomSearch, evoframe_evolvers

NETWORKS = (Neat, RandomSearch)


def test_they_are_registered_by_name() -> None:
    assert evoframe_evolvers() == {"genetic": Genetic, "neat": Neat, "random": RandomSearch}


@pytest.mark.parametrize("capability", [SupportsBitGeneration, SupportsGraph, SupportsProvenance])
@pytest.mark.parametrize("evolver", NETWORKS)
def test_each_evolver_of_networks_has_the_capabilities(evolver: type[Evolver], capability: type) -> None:
    assert isinstance(evolver(), capability)


@pytest.mark.parametrize("evolver", NETWORKS)
def test_the_version_of_neat_python_is_reported(evolver: type[Evolver]) -> None:
    component = evolver()
    assert isinstance(component, SupportsProvenance)
    assert [*component.provenance()] == ["neat-python"]


@pytest.mark.parametrize("capability", [SupportsLoad, SupportsSeeds])
@pytest.mark.parametrize("evolver", evoframe_evolvers().values())
def test_each_run_loads_genomes_and_starts_from_seeds(evolver: type[Evolver], capability: type) -> None:
    assert isinstance(evolver().start(3, 2, 5, np.random.default_rng(0)), capability)


@pytest.mark.parametrize("evolver", NETWORKS)
def test_networks_without_inputs_are_refused(evolver: type[Evolver]) -> None:
    with pytest.raises(ConfigurationError, match="found 0"):
        evolver().start(0, 2, 5, np.random.default_rng(0))


@pytest.mark.parametrize("evolver", evoframe_evolvers().values())
def test_seeds_after_the_initial_genomes_are_refused(evolver: type[Evolver]) -> None:
    run = evolver().start(3, 2, 5, np.random.default_rng(0))
    assert isinstance(run, SupportsSeeds)
    genomes = run.ask()
    with pytest.raises(RuntimeError, match="after ask"):
        run.seed(genomes[:1])
