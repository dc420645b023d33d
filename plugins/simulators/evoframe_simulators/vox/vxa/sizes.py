"""Limits of the sizes of voxels, by the rules of each engine."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["LARGEST", "SMALLEST", "read_sizes"]

SMALLEST = 0.1
"""Smallest size of a voxel in the fork, as a multiple of its edge, unless the file sets it."""

LARGEST = 3.0
"""Largest size of a voxel in the fork, as a multiple of its edge."""

_UNLIMITED = 10.0  # the largest limit that the solver accepts


def read_sizes(
    simulator: Section, environment: Section, strains: Sequence[float], engine: Engine, faults: Faults
) -> dict[str, Any]:
    """Return limits of sizes as options.

    Args:
        simulator: Section of the file.
        environment: Section of the file.
        strains: Largest thermal strain of each material, with its sign.
        engine: The engine whose rules apply.
        faults: Collects what vox cannot limit in the same way.
    """
    reach = max(map(abs, strains))
    smallest, largest, rule = SMALLEST, LARGEST, "hold"
    if engine is Engine.FORK:
        smallest = 1.0 if environment.flag("ExpandOnly") else simulator.number("MinTempFact", SMALLEST)
        largest = 1.0 if environment.flag("ContractOnly") else LARGEST
    elif engine is Engine.EVOSORO_LAND:
        smallest = simulator.number("MinTempFact", SMALLEST)
        largest = min(1.0 + environment.number("GrowthAmplitude", 0.0, least=0.0), _UNLIMITED)
        if environment.flag("StickyFloor"):
            faults.unsupported(environment.at("StickyFloor"), "'1'")
        if environment.flag("FallingProhibited"):
            faults.unsupported(environment.at("FallingProhibited"), "'1'", "vox has the rule of the fork")
    else:
        largest, rule = _UNLIMITED, "clamp"
        if 1.0 + reach > _UNLIMITED:
            faults.unsupported(
                environment.at("Thermal"), f"a strain of {reach:g}", "without a limit of sizes"
            )
        if engine is Engine.VOXCRAFT and not simulator.flag("EnableExpansion"):
            smallest, largest = _only_lowered(simulator, strains, faults)
    return {"smallest_size": smallest, "largest_size": largest, "size_rule": rule}


def _only_lowered(simulator: Section, strains: Sequence[float], faults: Faults) -> tuple[float, float]:
    """Return limits for a temperature that is never above the base, as in voxcraft without expansion."""
    if min(strains) < 0.0 < max(strains):
        faults.unsupported(
            simulator.at("EnableExpansion"), "'0'", "a temperature that only falls, with CTE of both signs"
        )
    return (SMALLEST, 1.0) if max(strains) > 0.0 else (1.0, _UNLIMITED)
