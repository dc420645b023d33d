"""Provenance of a run: versions, bit generations, local plugins and machine, compared on a resume."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from evoframe._version import __version__
from evoframe.contract import (
    Chosen,
    RunConfig,
    Source,
    SupportsBitGeneration,
    SupportsProvenance,
    bit_generation_of,
)
from evoframe.documents import Tree, differences
from evoframe.record.run import Run

__all__ = [
    "bit_generations_of",
    "changed_generations",
    "changed_provenance",
    "changed_scoring",
    "provenance_of",
    "recorded_generations",
]

_GENERATIONS = "bit_generations"
_LOCAL = "local_plugins"
_OBSERVERS = "observers"


def provenance_of(config: RunConfig, observers: Sequence[Source] = ()) -> Tree:
    """Return the table ``[provenance]``: versions, machine type, and the source of each component.

    Local plugins have no version; their source has a checksum instead. Components that state the generation
    of their results have it in the table ``bit_generations``.

    Args:
        config: The configuration.
        observers: Plugins that observe the run.
    """
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for _, chosen in config.components():
        if isinstance(chosen.component, SupportsProvenance):
            libraries |= chosen.component.provenance()
    deciding = dict(_deciding(config))
    generations = {
        key: number
        for key, number in bit_generations_of(config).items()
        if isinstance(deciding[key].component, SupportsBitGeneration)
    }
    sources = [chosen.source for chosen in deciding.values()]
    local = {source.distribution: source.digest for source in sources if source.digest}
    vectors = np.show_config(mode="dicts").get("SIMD Extensions", {})
    return {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "c_library": " ".join(platform.libc_ver()),
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in config.components()},
        **({_GENERATIONS: generations} if generations else {}),
        **({_LOCAL: local} if local else {}),
        **({_OBSERVERS: sorted(map(str, observers))} if observers else {}),
    }


def changed_provenance(run: Run, config: RunConfig) -> list[str]:
    """Return a line for each difference between the provenance of a run and that of this process."""
    then, now = dict(run.config.get("provenance", {})), provenance_of(config)
    if _LOCAL not in then:  # written before evoframe recorded it
        now.pop(_LOCAL, None)
    for tables in (then, now):
        tables.pop(_GENERATIONS, None)
        tables.pop(_OBSERVERS, None)  # the result does not depend on them
    return [*changed_generations(run, config).values(), *differences(then, now)]


def changed_generations(run: Run, config: RunConfig) -> dict[str, str]:
    """Return a line for each component whose results are of another generation than when the run started.

    Returns:
        Dotted key of the component -> the line, with both generations.
    """
    then, chosen = recorded_generations(run), dict(_deciding(config))
    return {
        key: f"bit generation of {key} '{chosen[key].name}': {then.get(key, 1)} then, {now} now"
        for key, now in bit_generations_of(config).items()
        if then.get(key, 1) != now
    }


def changed_scoring(run: Run, config: RunConfig) -> str:
    """Return the lines of :func:`changed_generations` about simulator and objective, which give scores."""
    scoring, changed = config.simulation(), changed_generations(run, config)
    return "; ".join(line for key, line in changed.items() if key in scoring)


def bit_generations_of(config: RunConfig) -> dict[str, int]:
    """Return the bit generation of each component that determines the result, by its dotted key."""
    return {key: bit_generation_of(chosen.component) for key, chosen in _deciding(config)}


def recorded_generations(run: Run) -> dict[str, int]:
    """Return the generations that were recorded when the run started: dotted key of a component -> number.

    A component that is missing had the number 1: it stated none, or evoframe did not record it yet.
    """
    recorded: Any = run.config.get("provenance", {}).get(_GENERATIONS)
    found = recorded.items() if isinstance(recorded, Mapping) else ()
    return {key: number for key, number in found if type(number) is int and number >= 1}


def _deciding(config: RunConfig) -> Iterator[tuple[str, Chosen[Any]]]:
    """Yield the components that determine the result (all but the executor) with their dotted keys."""
    return (item for item in config.components() if item[0] != "executor")
