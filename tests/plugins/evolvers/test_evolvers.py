"""The names of the built-in evolvers, and their optional capabilities."""

from __future__ import annotations

import pytest

from evoframe import Evolver, SupportsBitGeneration, SupportsGraph, SupportsProvenance
from evoframe_evolvers import Neat, RandomSearch, evoframe_evolvers


def test_they_are_registered_by_name() -> None:
    assert evoframe_evolvers() == {"neat": Neat, "random": RandomSearch}


@pytest.mark.parametrize("capability", [SupportsBitGeneration, SupportsGraph, SupportsProvenance])
@pytest.mark.parametrize("evolver", evoframe_evolvers().values())
def test_each_has_the_capabilities(evolver: type[Evolver], capability: type) -> None:
    assert isinstance(evolver(), capability)


@pytest.mark.parametrize("evolver", evoframe_evolvers().values())
def test_the_version_of_neat_python_is_reported(evolver: type[Evolver]) -> None:
    component = evolver()
    assert isinstance(component, SupportsProvenance)
    assert [*component.provenance()] == ["neat-python"]
