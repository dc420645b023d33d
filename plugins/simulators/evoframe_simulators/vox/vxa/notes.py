"""What depends on the dialect of a file: questions to the user, and notes on how it was read."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Final

from evoframe import InputError
from evoframe_simulators.vox.vxa.assembling import Document
from evoframe_simulators.vox.vxa.dialects import Engine, Reading
from evoframe_simulators.vox.vxa.environment import is_under_water, read_surroundings
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["notes_of", "refuse_ambiguity"]

_TASKS = ("ContractOnly", "ExpandOnly")
_IGNORED: Final[Mapping[Engine, tuple[str, ...]]] = {
    Engine.FORK: ("StickyFloor",),
    Engine.EVOSORO_LAND: (*_TASKS, "Gravity/FloorSlope"),
    Engine.EVOSORO_WATER: (*_TASKS, "FallingProhibited", "StickyFloor", "Gravity/FloorSlope"),
    Engine.VOXCRAFT: (*_TASKS, "FallingProhibited", "StickyFloor", "FluidEnvironment", "Gravity/FloorSlope"),
}
"""Tags of the section ``Environment`` that an engine does not read, although others do."""


def refuse_ambiguity(environment: Section, rules: Reading, given: Collection[str]) -> None:
    """Reject a file under water whose weight and floor depend on a dialect that nobody tells.

    Args:
        environment: Section of the file.
        rules: The rules by which it is read.
        given: Names of the options that the user sets.

    Raises:
        InputError: The dialect decides; names the option that chooses it.
    """
    if not rules.assumed or not is_under_water(environment):
        return
    one, other = (read_surroundings(environment, engine) for engine in (Engine.FORK, Engine.EVOSORO_WATER))
    if any(one[name] != other[name] for name in ("gravity", "floor") if name not in given):
        raise InputError(
            "the fork keeps gravity and floor in a fluid, evosoro disables both, and no tag tells which of "
            "them is meant; choose with --dialect fork or --dialect evosoro",
            key=environment.at("FluidEnvironment"),
        )


def notes_of(document: Document, rules: Reading, options: Mapping[str, Any], reach: float) -> Iterator[str]:
    """Yield what a user should know about the reading of a file, a line each.

    Args:
        document: The file.
        rules: The rules by which it was read.
        options: The options that it sets.
        reach: Largest thermal strain of a voxel.
    """
    if document.base is not None:
        yield f"completed by {document.base}"
    if not document.complete:
        yield "has no settings of a simulation: those of the preset apply (or name a VXA file with --base)"
        return
    environment = document.root.get("Environment")
    yield rules.described() + (_otherwise(environment, options, reach) if rules.assumed else "")
    if rules.engine is Engine.VOXCRAFT:
        yield "contacts, friction and damping follow the older Voxelyze, not voxcraft-sim"
    elif reach and not _varies(environment):
        yield "the temperature oscillates, since this engine ignores VaryTempEnabled"
    yield from _ignored(environment, _IGNORED[rules.engine], rules.engine)


def _otherwise(environment: Section, options: Mapping[str, Any], reach: float) -> str:
    """Return what evosoro would do otherwise with a file whose dialect is assumed, as the end of a note."""
    if is_under_water(environment):
        return ""
    largest = 1.0 + environment.number("GrowthAmplitude", 0.0)
    differences = [
        *([f"limits sizes to {largest:g}"] if 1.0 + reach > largest else []),
        *(["has no slope"] if options["floor_slope"] else []),
    ]
    return f" (evosoro {' and '.join(differences)}: --dialect evosoro)" if differences else ""


def _varies(environment: Section) -> bool:
    thermal = environment.get("Thermal")
    return thermal.text("VaryTempEnabled") is None or thermal.flag("VaryTempEnabled")


def _ignored(environment: Section, paths: Sequence[str], engine: Engine) -> Iterator[str]:
    """Yield a note for each tag with a value that the engine does not read."""
    for path in paths:
        section, tag = environment, path
        if "/" in path:
            inner, tag = path.split("/")
            section = environment.get(inner)
        value = section.number(tag, 0.0)
        if value != 0.0:
            yield f"{section.at(tag)} = {value:g} has no effect: {engine.value} does not read it"
